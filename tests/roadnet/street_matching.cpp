#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <set>
#include <utility>

#include "tests/roadnet/buckets.hpp"
#include "tests/roadnet/street_score.hpp"

namespace roadbook::test {
namespace {

constexpr double kMatchRadius_m = 60.0;
constexpr double kSigma_m = 15.0;
constexpr double kBeta_m = 20.0;
constexpr std::size_t kStates = 10;
constexpr double kNever = std::numeric_limits<double>::infinity();

struct State {
  int street = -1;
  double share = 0.0;  // of the street, from its place a
  double distance_m = 0.0;
};

struct Covered {
  int street = -1;
  double from = 0.0;
  double to = 1.0;
};

class TrackMatcher {
 public:
  explicit TrackMatcher(const StreetMap& map)
      : map_(map),
        near_(kMatchRadius_m),
        distance_(map.places.size(), kNever),
        from_(map.places.size(), -1) {
    for (std::size_t s = 0; s < map.streets.size(); ++s) {
      const Eigen::Vector2d a = end(map.streets[s].a);
      const Eigen::Vector2d d = end(map.streets[s].b) - a;
      const int pieces = static_cast<int>(d.norm() / 25.0) + 1;
      for (int k = 0; k <= pieces; ++k) near_.insert(a + d * k / pieces, static_cast<int>(s));
    }
  }

  [[nodiscard]] std::vector<Covered> match(const Track& track) {
    std::vector<Covered> all;
    std::vector<Eigen::Vector2d> at;
    std::vector<std::vector<State>> states;
    std::vector<std::vector<double>> costs;
    std::vector<std::vector<int>> before;
    const auto finish = [&] {
      if (states.size() > 1) trace(at, states, costs, before, all);
      at.clear();
      states.clear();
      costs.clear();
      before.clear();
    };
    for (const Eigen::Vector2d& position : track) {
      const std::vector<State> own = states_of(position);
      if (own.empty()) continue;
      std::vector<double> cost(own.size(), kNever);
      std::vector<int> from(own.size(), -1);
      if (!states.empty()) {
        const double straight_m = (position - at.back()).norm();
        for (std::size_t i = 0; i < states.back().size(); ++i) {
          search(states.back()[i], limit(straight_m));
          for (std::size_t j = 0; j < own.size(); ++j) {
            const double way_m = way(states.back()[i], own[j]).first;
            const double sum = costs.back()[i] + std::abs(way_m - straight_m) / kBeta_m;
            if (way_m > limit(straight_m) || sum >= cost[j]) continue;
            cost[j] = sum;
            from[j] = static_cast<int>(i);
          }
        }
      }
      if (*std::min_element(cost.begin(), cost.end()) == kNever) {
        finish();
        std::fill(cost.begin(), cost.end(), 0.0);
      }
      for (std::size_t j = 0; j < own.size(); ++j)
        cost[j] += 0.5 * std::pow(own[j].distance_m / kSigma_m, 2.0);
      at.push_back(position);
      states.push_back(own);
      costs.push_back(cost);
      before.push_back(from);
    }
    finish();
    return all;
  }

 private:
  [[nodiscard]] static double limit(double straight_m) { return 2.0 * straight_m + 300.0; }
  [[nodiscard]] const Street& street(int s) const {
    return map_.streets[static_cast<std::size_t>(s)];
  }
  [[nodiscard]] const Eigen::Vector2d& end(int place) const {
    return map_.places[static_cast<std::size_t>(place)];
  }
  [[nodiscard]] int other_end(int s, int place) const {
    return street(s).a == place ? street(s).b : street(s).a;
  }

  [[nodiscard]] std::vector<State> states_of(const Eigen::Vector2d& position) const {
    std::set<int> streets;
    near_.visit(position, kMatchRadius_m, [&](int s) { streets.insert(s); });
    std::vector<State> all;
    for (const int s : streets) {
      const Eigen::Vector2d a = end(street(s).a);
      const Eigen::Vector2d d = end(street(s).b) - a;
      const double l2 = d.squaredNorm();
      const double share = l2 > 0.0 ? std::clamp((position - a).dot(d) / l2, 0.0, 1.0) : 0.0;
      const double distance_m = (a + share * d - position).norm();
      if (distance_m <= kMatchRadius_m) all.push_back({s, share, distance_m});
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const State& a, const State& b) { return a.distance_m < b.distance_m; });
    if (all.size() > kStates) all.resize(kStates);
    return all;
  }

  void search(const State& start, double limit_m) {
    for (const int place : touched_) distance_[static_cast<std::size_t>(place)] = kNever;
    touched_.clear();
    using Open = std::pair<double, int>;
    std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
    const auto reach = [&](int place, double d, int by) {
      double& known = distance_[static_cast<std::size_t>(place)];
      if (d > limit_m || d >= known) return;
      if (known == kNever) touched_.push_back(place);
      known = d;
      from_[static_cast<std::size_t>(place)] = by;
      open.emplace(d, place);
    };
    reach(street(start.street).a, start.share * street(start.street).length_m, -1);
    reach(street(start.street).b, (1.0 - start.share) * street(start.street).length_m, -1);
    while (!open.empty()) {
      const auto [d, place] = open.top();
      open.pop();
      if (d > distance_[static_cast<std::size_t>(place)]) continue;
      for (const int s : map_.streets_at[static_cast<std::size_t>(place)])
        reach(other_end(s, place), d + street(s).length_m, s);
    }
  }

  // Length of the way to a state, and the last place on it (-1: along the same street).
  [[nodiscard]] std::pair<double, int> way(const State& from, const State& to) const {
    const Street& last = street(to.street);
    std::pair<double, int> best(kNever, -1);
    if (from.street == to.street) best.first = std::abs(from.share - to.share) * last.length_m;
    for (const bool at_a : {true, false}) {
      const int place = at_a ? last.a : last.b;
      const double d = distance_[static_cast<std::size_t>(place)] +
                       (at_a ? to.share : 1.0 - to.share) * last.length_m;
      if (d < best.first) best = {d, place};
    }
    return best;
  }

  void trace(const std::vector<Eigen::Vector2d>& at,
             const std::vector<std::vector<State>>& states,
             const std::vector<std::vector<double>>& costs,
             const std::vector<std::vector<int>>& before,
             std::vector<Covered>& all) {
    auto k = static_cast<std::size_t>(std::min_element(costs.back().begin(), costs.back().end()) -
                                      costs.back().begin());
    for (std::size_t i = states.size() - 1; i > 0; --i) {
      const auto p = static_cast<std::size_t>(before[i][k]);
      const State& from = states[i - 1][p];
      const State& to = states[i][k];
      search(from, limit((at[i] - at[i - 1]).norm()));
      int place = way(from, to).second;
      if (place < 0) {
        all.push_back({to.street, std::min(from.share, to.share), std::max(from.share, to.share)});
      } else {
        const auto part = [&](const State& s, int joint) {
          return street(s.street).a == joint ? Covered{s.street, 0.0, s.share}
                                             : Covered{s.street, s.share, 1.0};
        };
        all.push_back(part(to, place));
        for (int by = from_[static_cast<std::size_t>(place)]; by >= 0;
             by = from_[static_cast<std::size_t>(place)]) {
          all.push_back({by, 0.0, 1.0});
          place = other_end(by, place);
        }
        all.push_back(part(from, place));
      }
      k = p;
    }
  }

  const StreetMap& map_;
  Buckets near_;
  std::vector<double> distance_;
  std::vector<int> from_;  // street by which a place was reached
  std::vector<int> touched_;
};

}  // namespace

DrivenTimes driven_times(const StreetMap& map, const std::vector<Track>& tracks) {
  DrivenTimes times = not_driven(map);
  TrackMatcher matcher(map);
  for (const Track& track : tracks) {
    std::set<std::pair<int, std::size_t>> seen;
    for (const Covered& part : matcher.match(track)) {
      auto& own = times[static_cast<std::size_t>(part.street)];
      for (std::size_t k = 0; k < own.size(); ++k) {
        const double share = (static_cast<double>(k) + 0.5) / static_cast<double>(own.size());
        if (share < part.from || share > part.to) continue;
        if (seen.emplace(part.street, k).second) ++own[k];
      }
    }
  }
  return times;
}

}  // namespace roadbook::test
