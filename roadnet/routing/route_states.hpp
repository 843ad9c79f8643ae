#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "roadnet/network.hpp"
#include "roadnet/routing/routing_options.hpp"

namespace roadbook {

/// A traversal of a whole lane in one direction and gear: a state of the route search.
struct LaneState {
  int lane = -1;
  bool along = true;
  Gear gear = Gear::kForward;
  int enters = -1;  ///< node at which it begins
  int leaves = -1;
  Eigen::Vector2d heading_in = Eigen::Vector2d::UnitX();   ///< of the vehicle, at its beginning
  Eigen::Vector2d heading_out = Eigen::Vector2d::UnitX();  ///< at its end
  Eigen::Vector3d begin = Eigen::Vector3d::Zero();
  double cost_per_m = 1.0;
  bool ends_dead = false;  ///< at a dead end
};

/// Returns the states of all lanes. Nodes are the intersections, then one node for each dead end,
/// and one for each ring.
///
/// A lane may be driven in each direction in which a pass went. It may be driven in reverse gear,
/// in both directions, if a pass did so. It may be driven in every way if it has no pass.
[[nodiscard]] std::vector<LaneState> lane_states(const RoadNetwork& network,
                                                 const RoutingOptions& options);

/// Cost [m] of the transition from one state to the next; empty if it is impossible.
[[nodiscard]] std::optional<double> transition_cost(const LaneState& from,
                                                    const LaneState& to,
                                                    const RoutingOptions& options);

}  // namespace roadbook
