#pragma once

#include <string>
#include <vector>

#include "roadnet/routing/lane_layout.hpp"
#include "roadnet/routing/routing.hpp"

namespace roadbook {

/// A point on a route.
struct RoutePoint {
  double s_m = 0.0;  ///< from the begin of the route
  PathPoint at;      ///< in driving direction
  double width_m = 0.0;
  std::uint64_t lane = 0;  ///< id of the lane; on a turn, of the lane before it
  bool turn = false;       ///< on a curve across an intersection
};

/// A route as one curve, lanes and turns after each other: position, heading and curvature are
/// continuous.
struct RoutePath {
  std::vector<RoutePoint> points;  ///< empty if there is no single curve
  std::string reason;              ///< why there is no curve; empty if there is one
};

/// Samples the curve of a route about every `step_m`. A route with legs in reverse gear, or one
/// that turns round at a dead end, is no single curve.
[[nodiscard]] RoutePath route_path(const RoadNetwork& network,
                                   const LaneLayout& layout,
                                   const Route& route,
                                   double step_m);

}  // namespace roadbook
