#include "tests/roadnet/random_city.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "base/random.hpp"

namespace roadbook::test {
namespace {

constexpr double kTurn_rad = 0.3;
constexpr double kEast_m = 480000.0;
constexpr double kNorth_m = 4213000.0;

StreetMap streets_of(const RandomCity& city, Random& random) {
  StreetMap map;
  const int corners = city.blocks + 1;
  for (int i = 0; i < corners; ++i)
    for (int j = 0; j < corners; ++j) {
      const double x = city.block_m * (i + 0.1 * random.normal());
      const double y = city.block_m * (j + 0.1 * random.normal());
      map.add_place({kEast_m + std::cos(kTurn_rad) * x - std::sin(kTurn_rad) * y,
                     kNorth_m + std::sin(kTurn_rad) * x + std::cos(kTurn_rad) * y});
    }
  for (int i = 0; i < corners; ++i)
    for (int j = 0; j < corners; ++j) {
      if (i + 1 < corners && random.uniform() < 6.0 / 7.0)
        map.add_street(i * corners + j, (i + 1) * corners + j);
      if (j + 1 < corners && random.uniform() < 6.0 / 7.0)
        map.add_street(i * corners + j, i * corners + j + 1);
    }
  return map;
}

// Streets from one place to another, the shortest by lengths that every drive feels for itself.
std::vector<int> choose_way(const StreetMap& map, int from, int to, Random& random) {
  std::vector<double> felt;
  for (const Street& street : map.streets)
    felt.push_back(street.length_m * (1.0 + 0.6 * random.uniform()));
  std::vector<double> best(map.places.size(), std::numeric_limits<double>::infinity());
  std::vector<int> by(map.places.size(), -1);
  using Open = std::pair<double, int>;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
  best[static_cast<std::size_t>(from)] = 0.0;
  open.emplace(0.0, from);
  const auto other = [&](int s, int place) {
    const Street& street = map.streets[static_cast<std::size_t>(s)];
    return street.a == place ? street.b : street.a;
  };
  while (!open.empty()) {
    const auto [cost, place] = open.top();
    open.pop();
    if (cost > best[static_cast<std::size_t>(place)]) continue;
    for (const int s : map.streets_at[static_cast<std::size_t>(place)]) {
      const double sum = cost + felt[static_cast<std::size_t>(s)];
      double& known = best[static_cast<std::size_t>(other(s, place))];
      if (sum >= known) continue;
      known = sum;
      by[static_cast<std::size_t>(other(s, place))] = s;
      open.emplace(sum, other(s, place));
    }
  }
  std::vector<int> way;
  for (int place = to; place != from && by[static_cast<std::size_t>(place)] >= 0;) {
    way.push_back(by[static_cast<std::size_t>(place)]);
    place = other(way.back(), place);
  }
  std::reverse(way.begin(), way.end());
  return way;
}

DrivenPass drive(const StreetMap& map,
                 const std::vector<int>& way,
                 int place,
                 const RandomCity& city,
                 Random& random) {
  DrivenPass pass;
  double now_s = 0.0;
  double next_s = city.interval_s * random.uniform();
  const auto until = [&](double end_s, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    for (; next_s < end_s; next_s += city.interval_s) {
      const Eigen::Vector2d at = a + (b - a) * ((next_s - now_s) / (end_s - now_s));
      pass.positions.emplace_back(at.x() + city.noise_m * random.normal(),
                                  at.y() + city.noise_m * random.normal(), 0.0);
    }
    now_s = end_s;
  };
  for (const int s : way) {
    const Street& street = map.streets[static_cast<std::size_t>(s)];
    const Eigen::Vector2d a = map.places[static_cast<std::size_t>(place)];
    place = street.a == place ? street.b : street.a;
    const Eigen::Vector2d b = map.places[static_cast<std::size_t>(place)];
    until(now_s + street.length_m / (6.0 + 6.0 * random.uniform()), a, b);
    if (random.uniform() < 0.3) until(now_s + 10.0 + 30.0 * random.uniform(), b, b);
  }
  return pass;
}

}  // namespace

CityTracks drive_through(const RandomCity& city) {
  Random random(city.seed, "city");
  CityTracks tracks;
  tracks.map = streets_of(city, random);
  tracks.driven = not_driven(tracks.map);
  const double places = static_cast<double>(tracks.map.places.size());
  for (int d = 0; d < city.drives; ++d) {
    const int from = static_cast<int>(places * random.uniform());
    const int to = static_cast<int>(places * random.uniform());
    const std::vector<int> way = choose_way(tracks.map, from, to, random);
    DrivenPass pass = drive(tracks.map, way, from, city, random);
    if (pass.positions.size() < 2) continue;
    tracks.passes.push_back(std::move(pass));
    for (const int s : way)
      for (int& times : tracks.driven[static_cast<std::size_t>(s)]) ++times;
  }
  return tracks;
}

}  // namespace roadbook::test
