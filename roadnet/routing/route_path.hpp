#pragma once

#include <string>
#include <vector>

#include "roadnet/routing/lane_layout.hpp"
#include "roadnet/routing/routing.hpp"

namespace roadbook {

/// A place on a route, by the way driven.
struct RoutePoint {
  double s_m = 0.0;  ///< from the begin of the route
  PathPoint at;      ///< in driving direction
  double width_m = 0.0;
  std::uint64_t lane = 0;  ///< id; of the lane left, on a turn
  bool turn = false;
};

/// A route as one curve, lanes and turns after each other: position, heading and curvature are
/// continuous.
struct RoutePath {
  std::vector<RoutePoint> points;  ///< empty where there is none
  std::string reason;              ///< why there is none
};

/// The route's curve at places about `step_m` apart. A route with legs in reverse gear, or that
/// turns round at a dead end, is no single curve.
[[nodiscard]] RoutePath route_path(const RoadNetwork& network,
                                   const LaneLayout& layout,
                                   const Route& route,
                                   double step_m);

}  // namespace roadbook
