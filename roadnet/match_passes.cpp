#include "roadnet/match_passes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <utility>

#include "roadnet/spatial_hash.hpp"

namespace roadbook {
namespace {

constexpr double kCostANat = 2.0;      // reaches of way that make it e times less probable
constexpr double kStates = 3.0;        // standard deviations of a position
constexpr double kHopeless_nat = 6.0;  // worse than the best state by that: not followed

struct State {
  int place = -1;
  double cost_m = 0.0;
};

/// States of one position, and the tree of ways that led there from the one before.
struct Step {
  std::size_t position = 0;
  std::vector<State> states;
  std::vector<std::pair<int, int>> parents;  ///< place, the one before (-1: none); by place
};

class Matcher {
 public:
  Matcher(const WayGraph& graph, const TrackScales& scales)
      : graph_(graph),
        scales_(scales),
        nat_m_(kCostANat * scales.reach_m),
        radius_m_(std::max(kStates * scales.noise_m, scales.reach_m)),
        hash_(radius_m_),
        cost_(graph.places.size(), -1.0),
        parent_(graph.places.size(), -1),
        own_cost_(graph.places.size(), -1.0) {
    for (const Eigen::Vector3d& place : graph.places) hash_.insert(place);
  }

  void match(const DrivenPass& pass, MatchedPasses& result) {
    std::vector<Step> steps;
    for (std::size_t i = 0; i < pass.positions.size(); ++i) {
      Step next{i, states_of(pass.positions[i]), {}};
      if (next.states.empty()) continue;
      if (!steps.empty() && !lead_on(pass, steps.back(), next)) {
        write(pass, steps, result);
        steps.clear();
        next.states = states_of(pass.positions[i]);
      }
      steps.push_back(std::move(next));
    }
    write(pass, steps, result);
  }

 private:
  using Open = std::pair<double, int>;
  using Queue = std::priority_queue<Open, std::vector<Open>, std::greater<>>;

  [[nodiscard]] const Eigen::Vector3d& place(int at) const {
    return graph_.places[static_cast<std::size_t>(at)];
  }

  [[nodiscard]] std::vector<State> states_of(const Eigen::Vector3d& position) const {
    std::vector<State> states;
    hash_.visit_near(position, radius_m_, [&](int at, double d2) {
      states.push_back({at, 0.5 * d2 / (scales_.noise_m * scales_.noise_m) * nat_m_});
    });
    std::sort(states.begin(), states.end(),
              [](const State& a, const State& b) { return a.place < b.place; });
    return states;
  }

  void reach(int at, double cost, int from, Queue& open) {
    double& known = cost_[static_cast<std::size_t>(at)];
    if (known >= 0.0 && known <= cost) return;
    if (known < 0.0) touched_.push_back(at);
    known = cost;
    parent_[static_cast<std::size_t>(at)] = from;
    open.emplace(cost, at);
  }

  // Dijkstra from all states of `last` at once, until those of `next` that matter are reached.
  void search(const Step& last, const Step& next, double limit_m) {
    for (const int at : touched_) cost_[static_cast<std::size_t>(at)] = -1.0;
    touched_.clear();
    Queue open;
    for (const State& state : last.states) reach(state.place, state.cost_m, -1, open);
    std::size_t left = next.states.size();
    for (const State& state : next.states)
      own_cost_[static_cast<std::size_t>(state.place)] = state.cost_m;
    while (!open.empty() && left > 0) {
      const auto [cost, at] = open.top();
      open.pop();
      if (cost > limit_m) break;
      if (cost > cost_[static_cast<std::size_t>(at)]) continue;
      const double own = own_cost_[static_cast<std::size_t>(at)];
      if (own >= 0.0) {
        own_cost_[static_cast<std::size_t>(at)] = -1.0;
        limit_m = std::min(limit_m, cost + own + kHopeless_nat * nat_m_);
        --left;
      }
      for (const WayGraph::Edge& edge : graph_.edges[static_cast<std::size_t>(at)])
        if (cost + edge.cost_m <= limit_m) reach(edge.to, cost + edge.cost_m, at, open);
    }
    for (const State& state : next.states) own_cost_[static_cast<std::size_t>(state.place)] = -1.0;
  }

  // The Viterbi values of the next position; false: no way leads there.
  bool lead_on(const DrivenPass& pass, const Step& last, Step& next) {
    double least = last.states.front().cost_m;
    for (const State& state : last.states) least = std::min(least, state.cost_m);
    const double straight_m =
        (pass.positions[next.position] - pass.positions[last.position]).norm();
    search(last, next,
           least + straight_cost_m(straight_m + 2.0 * scales_.reach_m, scales_) +
               kHopeless_nat * nat_m_);
    std::vector<State> reached;
    for (const State& state : next.states) {
      const double cost = cost_[static_cast<std::size_t>(state.place)];
      if (cost >= 0.0) reached.push_back({state.place, cost - least + state.cost_m});
    }
    next.states = reached;
    for (const int at : touched_)
      next.parents.emplace_back(at, parent_[static_cast<std::size_t>(at)]);
    std::sort(next.parents.begin(), next.parents.end());
    return !reached.empty();
  }

  [[nodiscard]] static std::vector<int> way_to(int at, const Step& step) {
    std::vector<int> way;
    while (at >= 0) {
      way.push_back(at);
      at = std::lower_bound(step.parents.begin(), step.parents.end(), std::pair(at, -1))->second;
    }
    std::reverse(way.begin(), way.end());
    return way;
  }

  // From the state at `ways[s].back()` to its position, without what lies along the way there.
  [[nodiscard]] Eigen::Vector3d offset(const DrivenPass& pass,
                                       const std::vector<Step>& steps,
                                       const std::vector<std::vector<int>>& ways,
                                       std::size_t s) const {
    const std::vector<int>& in = ways[s];
    const std::vector<int>& out = ways[std::min(s + 1, ways.size() - 1)];
    const Eigen::Vector3d off = pass.positions[steps[s].position] - place(in.back());
    const int before = in.size() > 1 ? in[in.size() - 2] : in.back();
    const int after = s + 1 < ways.size() && out.size() > 1 ? out[1] : in.back();
    const Eigen::Vector3d along = (place(after) - place(before)).stableNormalized();
    return off - along.dot(off) * along;
  }

  void write(const DrivenPass& pass, const std::vector<Step>& steps, MatchedPasses& result) const {
    if (steps.size() < 2) return;
    std::vector<std::vector<int>> ways(steps.size());
    int at = std::min_element(steps.back().states.begin(), steps.back().states.end(),
                              [](const State& a, const State& b) { return a.cost_m < b.cost_m; })
                 ->place;
    for (std::size_t s = steps.size() - 1; s > 0; --s) {
      ways[s] = way_to(at, steps[s]);
      at = ways[s].front();
    }
    ways[0] = {at};
    Eigen::Vector3d last = offset(pass, steps, ways, 0);
    result.passes.push_back({pass.session, pass.reversing, {place(at) + last}});
    for (std::size_t s = 1; s < steps.size(); ++s) {
      const Eigen::Vector3d next = offset(pass, steps, ways, s);
      if (ways[s].back() < graph_.lane_places) result.offsets_m.push_back(next.norm());
      append(ways[s], last, next, result.passes.back().positions);
      last = next;
    }
  }

  // The places of a way, moved by the offset of its first position and more and more of its last.
  void append(const std::vector<int>& way,
              const Eigen::Vector3d& first,
              const Eigen::Vector3d& last,
              std::vector<Eigen::Vector3d>& line) const {
    double length_m = 0.0;
    for (std::size_t k = 1; k < way.size(); ++k)
      length_m += (place(way[k]) - place(way[k - 1])).norm();
    double done_m = 0.0;
    for (std::size_t k = 1; k < way.size(); ++k) {
      done_m += (place(way[k]) - place(way[k - 1])).norm();
      const double share = length_m > 0.0 ? done_m / length_m : 1.0;
      line.emplace_back(place(way[k]) + (1.0 - share) * first + share * last);
    }
  }

  const WayGraph& graph_;
  TrackScales scales_;
  double nat_m_;
  double radius_m_;
  SpatialHash hash_;
  std::vector<double> cost_;  // of the search; negative: not reached
  std::vector<int> parent_;
  std::vector<double> own_cost_;  // of the states that are searched for; else negative
  std::vector<int> touched_;
};

}  // namespace

MatchedPasses match_passes(const std::vector<DrivenPass>& passes,
                           const WayGraph& graph,
                           const TrackScales& scales) {
  MatchedPasses result;
  Matcher matcher(graph, scales);
  for (const DrivenPass& pass : passes) matcher.match(pass, result);
  return result;
}

}  // namespace roadbook
