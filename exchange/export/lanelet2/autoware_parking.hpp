#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "exchange/export/planner/lanelets.hpp"

namespace roadbook {

// Parking spaces as Autoware's extension of Lanelet2 has them: a line of two points with a width,
// that begins at the lane's side, within a polygon of the parking lot. Autoware finds a space's
// lanelet by geometry (autoware_lanelet2_extension, query.cpp, getLinkedLanelets): both touch the
// same lot, the line is within 5 m of the lanelet, and hits it when its length is added five times
// before its first point.

struct AutowareSpace {
  std::size_t space = 0;                            ///< index in PlannerMap::spaces
  Eigen::Vector3d front = Eigen::Vector3d::Zero();  ///< middle of the side at the lane
  Eigen::Vector3d back = Eigen::Vector3d::Zero();   ///< middle of the side opposite
  double width_m = 0.0;                             ///< across the line
  std::size_t lanelet = 0;                          ///< index of one that it is linked with
};

struct AutowareParking {
  std::vector<AutowareSpace> spaces;
  std::vector<std::vector<Eigen::Vector3d>> lots;  ///< rings without repetition
  std::size_t no_rectangle = 0;                    ///< spaces left out: other shapes
  std::size_t no_lane = 0;                         ///< spaces left out: without a lane that fits
};

/// Spaces that Autoware links with the lane they belong to, and lots that hold them: the ground of
/// the spaces, of the ways to them, and of the lanelets they are linked with. A space along a lane,
/// whose open side does not face the lane, is entered from its side at the lane.
[[nodiscard]] AutowareParking autoware_parking(const PlannerMap& map,
                                               const LaneletNetwork& network);

}  // namespace roadbook
