#pragma once

#include <Eigen/Core>
#include <vector>

#include "exchange/export/label_outlines.hpp"

namespace roadbook {

// Shapes of outlines within the rounding of their file. Other programs round to pixels or decimals,
// repeat the first corner, and double corners.

/// Distance between neighbouring values that a writer could have written: 10^-d for the fewest
/// decimals d (0 to 9) that all `values` have, or what single precision leaves of the largest. 0
/// where they have more decimals than that.
[[nodiscard]] double rounding_step(const std::vector<double>& values);

/// Largest distance of a corner in a file from its drawn position [m]: one step in each coordinate,
/// because some programs truncate digits; at least 1 mm.
[[nodiscard]] double corner_tolerance(const LabelOutline& outline);
/// Largest distance of four rounded corners from a rectangle [m], as `is_rectangle` measures it: 2
/// cm, or the effect of rounding all four corners, up to 15 % of the shortest side.
[[nodiscard]] double rectangle_tolerance(const LabelOutline& outline);

/// Removes redundant corners: a corner that repeats the one before, and a last one that repeats the
/// first. An outline within the tolerance of a rectangle then keeps its four corners alone, unless
/// the file calls it a polygon.
void clean_corners(LabelOutline& outline);

/// The largest distance of a corner of one outline to the sides of the other [m].
[[nodiscard]] double outline_distance(const std::vector<Eigen::Vector2d>& a,
                                      const std::vector<Eigen::Vector2d>& b);

/// Area common to both over the area that either covers, 0 to 1. Outlines must not cross
/// themselves; 0 where one cannot be cut.
[[nodiscard]] double intersection_over_union(const std::vector<Eigen::Vector2d>& a,
                                             const std::vector<Eigen::Vector2d>& b);

/// Twice the area, positive where the corners go counter-clockwise.
[[nodiscard]] double twice_signed_area(const std::vector<Eigen::Vector2d>& corners);

}  // namespace roadbook
