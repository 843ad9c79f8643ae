#pragma once

#include <Eigen/Core>
#include <vector>

#include "roadnet/paths/bezier_path.hpp"

namespace roadbook {

// Fits a path with continuous curvature to a polyline [SPM, section 3.1]: least squares over M
// Bezier curves with continuity of the first two derivatives.
//
// The continuity is built into the unknowns instead of being imposed on them: they are the
// coefficients of the B-splines of the degree whose inner knots count degree - 2 times, (degree -
// 2) M + 3 for an open path. The normal equations are then banded; control points follow from the
// coefficients by blossoming.

struct PathFitOptions {
  int segments = 40;  ///< M
  int degree = 6;
  bool closed = false;
  bool pin_ends = false;  ///< an open path runs exactly from its first to its last point
  /// Wiggles of this wavelength are halved, shorter ones all but removed (penalty on the third
  /// derivative). 0: plain least squares, as in [SPM].
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

/// Fits with the points' summed chord lengths as parameters and joints equally far apart. A closed
/// path may repeat its first point at the end or not.
///
/// Linear in points and segments; single-threaded. Throws InvalidOption, and BadInput for fewer
/// than two points (closed: three), values that are not finite, neighbours that coincide, and
/// segments that too few points fall into.
[[nodiscard]] PathFit fit_path(const std::vector<Eigen::Vector3d>& points,
                               const PathFitOptions& options = {});

/// The same with the points' parameters `t` given, in [0, t_end] in any order; joints equally far
/// apart. `weights`: of the points' squared distances, 0 or more; empty: all 1. `rms_m` is
/// weighted.
[[nodiscard]] PathFit fit_path(const std::vector<Eigen::Vector3d>& points,
                               const std::vector<double>& t,
                               double t_end,
                               const PathFitOptions& options = {},
                               const std::vector<double>& weights = {});

}  // namespace roadbook
