#pragma once

#include <Eigen/Core>
#include <vector>

#include "roadnet/routing/lane_layout.hpp"

namespace roadbook {

// Bounds of lanes and turns, for formats that describe a lane by the lines to its left and right.
//
// The distance of a bound from the curve is half the lane's width. On the inner side of a tight
// bend, where its curvature would exceed `kMostBoundCurvature`, the bound cuts the corner on its
// far side: the lane becomes wider there, never narrower than the driven width. Lanelet2's
// validator warns of bounds with more than 0.5 1/m.

inline constexpr double kMostBoundCurvature = 0.47;  ///< [1/m]

/// Both bounds as dense polylines, about 0.1 m between the places.
struct LaneBounds {
  std::vector<double> s_m;             ///< places on the curve, ascending
  std::vector<Eigen::Vector3d> left;   ///< to the left of each place [m, map frame]
  std::vector<Eigen::Vector3d> right;  ///< to the right

  /// The part between two places, with points at both, between neighbours on the polyline.
  [[nodiscard]] LaneBounds part(double begin_m, double end_m) const;
  /// Length of the line midway between the bounds [m].
  [[nodiscard]] double centre_length_m() const;
};

/// Bounds of a lane from its `s_begin_m` to its `s_end_m`. The ends lie square to the curve.
[[nodiscard]] LaneBounds bounds_of(const LanePiece& piece);

/// Bounds of a turn, which begin and end at the corners of the lanes it joins. The width changes
/// smoothly from one lane to the other.
[[nodiscard]] LaneBounds bounds_of(const Connector& turn, const LaneLayout& layout);

/// Whether the chord between two points of a polyline fits the points between them: within 3 mm, in
/// plan, and no longer than 2 m.
[[nodiscard]] bool chord_fits(const std::vector<Eigen::Vector3d>& line,
                              std::size_t from,
                              std::size_t to);

/// Largest curvature [1/m] of the circles through any three neighbours of a polyline, in plan.
[[nodiscard]] double largest_curvature(const std::vector<Eigen::Vector3d>& line);

}  // namespace roadbook
