#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "exchange/export/planner/lanelets.hpp"

namespace roadbook {

/// A pedestrian crossing as a lanelet: pedestrians walk from the first points of its bounds to the
/// last ones, across the lane.
struct Crosswalk {
  std::array<Eigen::Vector3d, 2> left;
  std::array<Eigen::Vector3d, 2> right;
  std::vector<Eigen::Vector3d> outline;  ///< as the map has it
  std::vector<std::size_t> crossed;      ///< indices of the lanelets that the crossing lies on
  bool rectangle = true;  ///< otherwise the bounds are those of the rectangle around the outline
};

/// The crosswalk of a crossing; empty where its outline encloses no ground or crosses itself. Two
/// sides of a crossing with four corners are its bounds: those that lie across the nearest
/// lanelet's direction, or the longer ones where no lanelet is within 15 m.
[[nodiscard]] std::optional<Crosswalk> crosswalk_of(const PlannerCrossing& crossing,
                                                    const LaneletNetwork& network);

}  // namespace roadbook
