#pragma once

#include <Eigen/Core>
#include <vector>

#include "roadnet/paths/bezier_path.hpp"

namespace roadbook {

// Fits a path with continuous curvature to a polyline [SPM, section 3.1]: least squares over M
// Bezier curves with continuity of the first two derivatives.
//
// The unknowns are chosen so that every solution is continuous: the coefficients of the B-splines
// whose inner knots have multiplicity degree - 2. An open path has (degree - 2) M + 3 of them. The
// normal equations are banded. Control points follow from the coefficients by blossoming.

struct PathFitOptions {
  int segments = 40;  ///< M
  int degree = 6;
  bool closed = false;
  bool pin_ends = false;  ///< an open path runs exactly from its first to its last point
  /// Oscillations of this wavelength are halved, shorter ones almost removed (penalty on the third
  /// derivative). 0: plain least squares, as in the paper.
  double smooth_below_m = 0.0;

  /// Throws InvalidOption.
  void check() const;
};

struct PathFit {
  BezierPath path;
  double rms_m = 0.0;            ///< distance of the points from the curve at their parameters
  double max_deviation_m = 0.0;  ///< the largest of them: not less than the true distance
  std::size_t worst_point = 0;
};

/// Fits a path to `points` [m, map], with the cumulative chord lengths as parameters and
/// equidistant joints. A closed path may repeat its first point at the end or not.
///
/// Linear in points and segments; single-threaded. Throws InvalidOption, and BadInput for fewer
/// than two points (closed: three), values that are not finite, neighbours that coincide, and
/// segments that too few points fall into.
[[nodiscard]] PathFit fit_path(const std::vector<Eigen::Vector3d>& points,
                               const PathFitOptions& options = {});

/// The same with given parameters `t` of the points, in [0, t_end] in any order, and equidistant
/// joints. `weights`: of the points' squared distances, 0 or more; empty: all 1. `rms_m` is
/// weighted.
[[nodiscard]] PathFit fit_path(const std::vector<Eigen::Vector3d>& points,
                               const std::vector<double>& t,
                               double t_end,
                               const PathFitOptions& options = {},
                               const std::vector<double>& weights = {});

}  // namespace roadbook
