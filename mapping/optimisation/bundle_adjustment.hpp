#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/progress.hpp"
#include "mapping/optimisation/adjustment_problem.hpp"

namespace roadbook {

// Full bundle adjustment: estimates vehicle poses and landmarks from the pixels where the cameras
// saw the landmarks and from measured motions between poses [metric-semantic maps, section IV-B].
//
// Two solvers minimise the same cost. The own one is Levenberg-Marquardt: landmarks are eliminated
// (Schur complement), and a sparse block Cholesky factors the reduced system of the poses. It uses
// all threads and gives the same bytes on any number of them, which Ceres' Schur solvers do not.
// The other is Ceres on one thread. bench/bundle_adjustment_study compares their times.

struct BundleResult {
  bool usable = false;  ///< finite, and the cost did not rise
  bool converged = false;
  double initial_cost = 0.0;             ///< half the sum of robust squared residuals at the start
  double final_cost = 0.0;               ///< the same at the end, over inliers
  int iterations = 0;                    ///< linear solves in all rounds
  double reprojection_rms_px = 0.0;      ///< per coordinate, sqrt(sum |r|^2 / (2 n)), over inliers
  double reprojection_median_px = 0.0;   ///< of |r|, over inliers
  std::size_t degrees_of_freedom = 0;    ///< 2 * inliers - free parameters
  std::vector<std::uint8_t> inlier;      ///< of each observation
  std::vector<std::uint8_t> point_kept;  ///< of each point: at least two inliers (or fixed)
  std::string message;
};

/// Improves `problem` in place (poses, points, scale values).
///
/// An observation is removed if its chi2 is too large, if the camera cannot see the point, or if
/// its point has no other observation. A point without observations keeps its position. If the
/// result is not usable, `problem` stays unchanged. The same bytes for any number of threads.
/// Throws BadInput for indices out of range and values that are not finite; InvalidOption;
/// Interrupted.
BundleResult bundle_adjust(BundleProblem& problem,
                           const BundleOptions& options = {},
                           const Progress& progress = {});

}  // namespace roadbook
