#pragma once

#include <string>
#include <vector>

#include "exchange/export/opendrive/opendrive_geometry.hpp"
#include "exchange/export/opendrive/opendrive_roads.hpp"

namespace roadbook {

/// A parking space or a crossing next to a road. Its rectangle, the only part that SUMO reads, is
/// centred at `s_m`, `t_m`; the outline is exact.
struct DriveObject {
  bool crossing = false;
  std::string id;
  double s_m = 0.0;       ///< from the begin of the road to the middle of the rectangle
  double t_m = 0.0;       ///< to the left of the road
  double z_m = 0.0;       ///< above the road
  double turn_rad = 0.0;  ///< from the direction of the road to that of the length
  double length_m = 0.0;  ///< of a space: from its open side to its back
  double width_m = 0.0;
  std::vector<Eigen::Vector3d> outline{};  ///< ahead, left and up in the frame of the rectangle
  const SpaceLink* link = nullptr;         ///< of the planner's map; null: none
};

struct RoadObjects {
  std::vector<DriveObject> objects;
  std::vector<DriveStretch> stretches;  ///< one chord each, so that SUMO shows objects correctly
};

struct DriveObjects {
  std::vector<RoadObjects> of_road;  ///< one a road
  std::size_t not_rectangles = 0;    ///< outlines more than 1 cm from their rectangle
  std::size_t displaced = 0;         ///< next to no road: SUMO shows them elsewhere
};

/// Assigns spaces and crossings to roads. A space belongs to the road of its link if it lies next
/// to that road; other objects belong to the nearest road.
[[nodiscard]] DriveObjects drive_objects(const PlannerMap& planner, const DriveRoads& roads);

/// A rectangle around an outline: along the sides of an outline with four corners, otherwise the
/// smallest one.
struct OutlineBox {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  Eigen::Vector2d ahead = Eigen::Vector2d::UnitX();  ///< from the first side to the opposite one
  double length_m = 0.0;
  double width_m = 0.0;
  double deviation_m = 0.0;  ///< largest distance of a corner of the box from the outline's corners
};
[[nodiscard]] OutlineBox box_of(const std::vector<Eigen::Vector3d>& corners);

}  // namespace roadbook
