#pragma once

#include <Eigen/Core>
#include <optional>

#include "roadnet/network.hpp"

namespace roadbook {

/// A position on the network: a lane and the distance along its centre polyline.
struct NetworkPlace {
  int lane = -1;
  double s_m = 0.0;         ///< from the first point of the lane's centre
  double distance_m = 0.0;  ///< of the point asked for from the centre line
};

/// The place on the network nearest to a point within `reach_m`; lanes more than 1.5 m above or
/// below are another floor's. A height that is not known (NaN) fits any floor.
[[nodiscard]] std::optional<NetworkPlace> nearest_place(const RoadNetwork& network,
                                                        const Eigen::Vector3d& point,
                                                        double reach_m);
/// The centre at `s_m`, and its direction first to last (unit, in plan).
struct LaneSpot {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();
};
[[nodiscard]] LaneSpot lane_spot(const Lane& lane, double s_m);

}  // namespace roadbook
