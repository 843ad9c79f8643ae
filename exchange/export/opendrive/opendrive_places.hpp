#pragma once

#include <optional>
#include <vector>

#include "exchange/export/opendrive/opendrive_geometry.hpp"
#include "exchange/export/opendrive/opendrive_roads.hpp"

namespace roadbook {

// Places at roads as SUMO's netconvert 1.15 reads them: it replaces a road by chords, and measures
// s, t and the direction of an object on them. On a bend these differ by decimetres from the curve.
// So a road gets one chord around each place, and places are given relative to these chords.

/// Where the normal of a road goes through a point.
struct RoadFoot {
  Eigen::Vector2d point = Eigen::Vector2d::Zero();
  double s_m = 0.0;  ///< on the curve
  double t_m = 0.0;  ///< to its left
};

/// All of a point.
[[nodiscard]] std::vector<RoadFoot> feet_of(const DriveRoad& road, const Eigen::Vector2d& point);

/// Stretches of a road, ascending, so that every point lies across one of them; none where points
/// are too close to each other along the road, or to its ends. `feet` in any order.
[[nodiscard]] std::optional<std::vector<DriveStretch>> stretches_across(const DriveRoad& road,
                                                                        std::vector<RoadFoot> feet);

/// A point across the chord of a stretch.
struct ChordPlace {
  double s_m = 0.0;          ///< on the curve of the road, counted along the chord
  double t_m = 0.0;          ///< to the left of the chord
  double heading_rad = 0.0;  ///< of the chord, map frame
};
/// None where the point lies across none of them.
[[nodiscard]] std::optional<ChordPlace> place_across(const DriveRoad& road,
                                                     const std::vector<DriveStretch>& stretches,
                                                     const Eigen::Vector2d& point);

}  // namespace roadbook
