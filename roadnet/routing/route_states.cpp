#include "roadnet/routing/route_states.hpp"

#include <algorithm>
#include <cmath>

#include "roadnet/routing/network_place.hpp"

namespace roadbook {
namespace {

struct Ends {
  int first = -1;
  int last = -1;
  bool first_dead = false;
  bool last_dead = false;
};

std::vector<Ends> number_ends(const RoadNetwork& network) {
  std::vector<Ends> ends;
  int node = static_cast<int>(network.intersections.size());
  for (const Lane& lane : network.lanes) {
    Ends e{lane.from_intersection, lane.to_intersection, false, false};
    if (lane.closed) {
      e.first = e.last = node++;
    } else {
      e.first_dead = e.first < 0;
      e.last_dead = e.last < 0;
      if (e.first_dead) e.first = node++;
      if (e.last_dead) e.last = node++;
    }
    ends.push_back(e);
  }
  return ends;
}

bool allowed(const Lane& lane, bool along, Gear gear, const RoutingOptions& options) {
  const bool nothing_known = lane.forward_passes == 0 && lane.backward_passes == 0;
  if (gear == Gear::kReverse) return options.allow_reverse && (lane.reverse_gear_passes > 0);
  return nothing_known || (along ? lane.forward_passes : lane.backward_passes) > 0;
}

}  // namespace

std::vector<LaneState> lane_states(const RoadNetwork& network, const RoutingOptions& options) {
  const auto ends = number_ends(network);
  std::vector<LaneState> states;
  for (std::size_t l = 0; l < network.lanes.size(); ++l) {
    const Lane& lane = network.lanes[l];
    if (lane.centre.size() < 2) continue;
    const double in = std::min(options.direction_over_m, 0.5 * lane.length_m);
    const Eigen::Vector3d from_first = lane_spot(lane, in).position - lane.centre.front();
    const Eigen::Vector3d to_last =
        lane.centre.back() - lane_spot(lane, lane.length_m - in).position;
    for (const bool along : {true, false}) {
      for (const Gear gear : {Gear::kForward, Gear::kReverse}) {
        if (!allowed(lane, along, gear, options)) continue;
        LaneState state;
        state.lane = static_cast<int>(l);
        state.along = along;
        state.gear = gear;
        state.enters = along ? ends[l].first : ends[l].last;
        state.leaves = along ? ends[l].last : ends[l].first;
        state.ends_dead = along ? ends[l].last_dead : ends[l].first_dead;
        // The vehicle looks where it goes, or away from it.
        const double sign = (along ? 1.0 : -1.0) * (gear == Gear::kForward ? 1.0 : -1.0);
        const Eigen::Vector2d a = sign * from_first.head<2>().stableNormalized();
        const Eigen::Vector2d b = sign * to_last.head<2>().stableNormalized();
        state.heading_in = along ? a : b;
        state.heading_out = along ? b : a;
        state.begin = along ? lane.centre.front() : lane.centre.back();
        state.cost_per_m = gear == Gear::kForward ? 1.0 : options.reverse_factor;
        states.push_back(state);
      }
    }
  }
  return states;
}

std::optional<double> transition_cost(const LaneState& from,
                                      const LaneState& to,
                                      const RoutingOptions& options) {
  if (from.leaves != to.enters) return std::nullopt;
  const double turn = std::acos(std::clamp(from.heading_out.dot(to.heading_in), -1.0, 1.0));
  const bool same_gear = from.gear == to.gear;
  const bool turns_round = from.ends_dead && same_gear && from.gear == Gear::kForward;
  if (turns_round) return options.turn_round_cost_m;
  if (turn > options.max_turn_rad) return std::nullopt;
  return turn * options.turn_cost_m_per_rad + (same_gear ? 0.0 : options.gear_change_cost_m);
}

}  // namespace roadbook
