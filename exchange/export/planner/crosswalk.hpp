#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "exchange/export/export_notes.hpp"
#include "exchange/export/planner/lanelets.hpp"

namespace roadbook {

/// A pedestrian crossing as a lanelet: pedestrians walk from the first points of its bounds to the
/// last ones, across the lane.
struct Crosswalk {
  std::string label;  ///< id of the crossing
  std::array<Eigen::Vector3d, 2> left;
  std::array<Eigen::Vector3d, 2> right;
  std::vector<Eigen::Vector3d> outline;  ///< as the map has it
  std::vector<std::size_t> crossed;      ///< indices of the lanelets that the crossing lies on
  bool rectangle = true;  ///< otherwise the bounds are those of the rectangle around the outline
};

/// The crosswalks of a map, in the order of its crossings. Two sides of a crossing with four
/// corners are its bounds: those that lie across the nearest lanelet's direction, or the longer
/// ones where no lanelet is within 15 m. Left out, with a note: crossings whose outline encloses no
/// ground or crosses itself. `any_shape`: the format holds outlines as well as bounds; otherwise
/// outlines that are no rectangles are noted.
[[nodiscard]] std::vector<Crosswalk> crosswalks_of(const PlannerMap& map,
                                                   const LaneletNetwork& network,
                                                   bool any_shape,
                                                   ExportNotes& notes);

}  // namespace roadbook
