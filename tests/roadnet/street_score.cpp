#include "tests/roadnet/street_score.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/roadnet/buckets.hpp"

namespace roadbook::test {
namespace {

constexpr double kSample_m = 5.0;
constexpr double kMaxTurn_rad = std::numbers::pi / 6.0;

struct Sample {
  Eigen::Vector2d at;
  Eigen::Vector2d direction;
};

std::vector<Sample> samples_of(const Track& line) {
  std::vector<Sample> samples;
  double next_m = 0.5 * kSample_m;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Eigen::Vector2d d = line[i + 1] - line[i];
    const double length_m = d.norm();
    for (; next_m < length_m; next_m += kSample_m)
      samples.push_back({line[i] + d * (next_m / length_m), d / length_m});
    next_m -= length_m;
  }
  return samples;
}

double share_matched(const std::vector<Sample>& of, const std::vector<Sample>& to, double near_m) {
  Buckets buckets(near_m);
  for (std::size_t i = 0; i < to.size(); ++i) buckets.insert(to[i].at, static_cast<int>(i));
  const double along = std::cos(kMaxTurn_rad);
  std::size_t hits = 0;
  for (const Sample& sample : of) {
    bool hit = false;
    buckets.visit(sample.at, near_m, [&](int i) {
      const Sample& other = to[static_cast<std::size_t>(i)];
      hit = hit || ((other.at - sample.at).norm() <= near_m &&
                    std::abs(other.direction.dot(sample.direction)) >= along);
    });
    hits += hit ? 1U : 0U;
  }
  return of.empty() ? 0.0 : static_cast<double>(hits) / static_cast<double>(of.size());
}

}  // namespace

int StreetMap::add_place(const Eigen::Vector2d& at) {
  places.push_back(at);
  streets_at.emplace_back();
  return static_cast<int>(places.size()) - 1;
}

int StreetMap::add_street(int a, int b) {
  const int s = static_cast<int>(streets.size());
  const auto place = [this](int p) { return places[static_cast<std::size_t>(p)]; };
  streets.push_back({a, b, (place(a) - place(b)).norm()});
  streets_at[static_cast<std::size_t>(a)].push_back(s);
  streets_at[static_cast<std::size_t>(b)].push_back(s);
  return s;
}

DrivenTimes not_driven(const StreetMap& map) {
  DrivenTimes times;
  for (const Street& street : map.streets)
    times.emplace_back(
        std::max<std::size_t>(1, static_cast<std::size_t>(street.length_m / kSample_m)), 0);
  return times;
}

StreetScore score_streets(const std::vector<Track>& network,
                          const StreetMap& map,
                          const DrivenTimes& driven,
                          int times,
                          double near_m) {
  std::vector<Sample> found;
  for (const Track& line : network) {
    const std::vector<Sample> own = samples_of(line);
    found.insert(found.end(), own.begin(), own.end());
  }
  std::vector<Sample> all;
  std::vector<Sample> once;
  std::vector<Sample> wanted;
  for (std::size_t s = 0; s < map.streets.size(); ++s) {
    const Eigen::Vector2d a = map.places[static_cast<std::size_t>(map.streets[s].a)];
    const Eigen::Vector2d d = map.places[static_cast<std::size_t>(map.streets[s].b)] - a;
    for (std::size_t k = 0; k < driven[s].size(); ++k) {
      const double share = (static_cast<double>(k) + 0.5) / static_cast<double>(driven[s].size());
      const Sample sample{a + share * d, d.stableNormalized()};
      all.push_back(sample);
      if (driven[s][k] >= 1) once.push_back(sample);
      if (driven[s][k] >= times) wanted.push_back(sample);
    }
  }
  return {share_matched(found, all, near_m), share_matched(found, once, near_m),
          share_matched(wanted, found, near_m), static_cast<double>(found.size()) * kSample_m / 1e3,
          static_cast<double>(wanted.size()) * kSample_m / 1e3};
}

}  // namespace roadbook::test
