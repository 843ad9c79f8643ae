#pragma once

#include <Eigen/Core>
#include <vector>

#include "exchange/export/nav2/vehicle_footprint.hpp"
#include "exchange/export/planner/planner_map.hpp"

namespace roadbook {

// The ground between a parking space and its lane, for spaces that have a link.

/// Position of the vehicle's rear axle [m, map] and its direction (unit).
struct VehiclePlace {
  Eigen::Vector2d position;
  Eigen::Vector2d heading;
};

/// The ground from the side of the entry straight to the lane's centre, as wide as that side and at
/// least `width_m`. The side of the entry is the open side or, if the space lies along its lane,
/// the long side that faces the lane. Returns a ring [m, map].
[[nodiscard]] std::vector<Eigen::Vector2d> ground_before(const PlannerSpace& space,
                                                         const LaneLayout& layout,
                                                         double width_m);

/// Poses, a few centimetres apart, of a vehicle that reverses from the lane into the middle of the
/// space: an arc of 5.5 m radius (tighter where there is no room, not below 3.5 m) and a straight
/// line; into a space along its lane two arcs of 5.5 m. One run for each direction in which the
/// lane is driven; none where no such arcs fit.
[[nodiscard]] std::vector<VehiclePlace> reversing_into(const PlannerSpace& space,
                                                       const LaneLayout& layout,
                                                       const VehicleFootprint& vehicle);

}  // namespace roadbook
