#pragma once

#include <optional>
#include <vector>

#include "exchange/export/opendrive/opendrive_geometry.hpp"
#include "exchange/export/opendrive/opendrive_roads.hpp"

namespace roadbook {

// Positions next to roads in the form that SUMO's netconvert 1.15 reads. It replaces a road by
// chords, and measures s, t and the direction of an object on them. On a bend these differ by
// decimetres from the curve. So a road gets one chord at each object, and positions are relative to
// these chords.

/// A foot point: the position of a road whose normal goes through a point.
struct RoadFoot {
  Eigen::Vector2d point = Eigen::Vector2d::Zero();
  double s_m = 0.0;  ///< on the curve
  double t_m = 0.0;  ///< to its left
};

/// Returns all foot points of a point [m, map].
[[nodiscard]] std::vector<RoadFoot> feet_of(const DriveRoad& road, const Eigen::Vector2d& point);

/// Chooses stretches of a road, ascending, so that every point lies across one of them. Empty if
/// points are too close to each other along the road, or to its ends. `feet`: in any order.
[[nodiscard]] std::optional<std::vector<DriveStretch>> stretches_across(const DriveRoad& road,
                                                                        std::vector<RoadFoot> feet);

/// A position relative to the chord of a stretch.
struct ChordPlace {
  double s_m = 0.0;          ///< on the curve of the road, counted along the chord
  double t_m = 0.0;          ///< to the left of the chord
  double heading_rad = 0.0;  ///< of the chord, map frame
};
/// Returns the position of a point relative to the stretch that it lies across; empty if there is
/// none.
[[nodiscard]] std::optional<ChordPlace> place_across(const DriveRoad& road,
                                                     const std::vector<DriveStretch>& stretches,
                                                     const Eigen::Vector2d& point);

}  // namespace roadbook
