#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "roadnet/network.hpp"
#include "roadnet/routing/routing_options.hpp"

namespace roadbook {

/// A way of driving over a whole lane.
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

/// Nodes: intersections, then a node of its own for each dead end, and one for each ring.
///
/// A lane may be driven in a direction in which vehicles were seen to go; backwards in both, where
/// one was seen to back up; in every way where nothing is known.
[[nodiscard]] std::vector<LaneState> lane_states(const RoadNetwork& network,
                                                 const RoutingOptions& options);

/// What going over from one state to the next costs [m]; none where it is not possible.
[[nodiscard]] std::optional<double> transition_cost(const LaneState& from,
                                                    const LaneState& to,
                                                    const RoutingOptions& options);

}  // namespace roadbook
