#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "exchange/export/planner/lanelets.hpp"

namespace roadbook {

// Parking spaces for Autoware's extension of Lanelet2: a line of two points with a width that
// begins at the lane's side, inside a polygon of the parking lot. Autoware finds the lanelet of a
// space by geometry (autoware_lanelet2_extension, query.cpp, getLinkedLanelets). Both touch the
// same lot, the line is within 5 m of the lanelet, and it hits the lanelet when extended by five
// times its length before its first point.

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

/// Returns the spaces that Autoware links with their lane, and the lots around them: the ground of
/// the spaces, between spaces and lanelets, and of the linked lanelets. A space along a lane, whose
/// open side does not face the lane, is entered from its side at the lane.
[[nodiscard]] AutowareParking autoware_parking(const PlannerMap& map,
                                               const LaneletNetwork& network);

}  // namespace roadbook
