#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "base/se3.hpp"
#include "mapping/optimisation/bundle_adjustment.hpp"

namespace roadbook {

// Uncertainty of a bundle-adjusted map, from the normal equations at its optimum.
//
// Gauge: covariances of poses are relative to the fixed poses (usually the first one), whose own
// covariance is zero. Covariances of landmarks are conditional on the poses. Unknown is NaN.

struct BundleCovariance {
  bool usable = false;          ///< false: singular normal equations, for example a free scale
  std::vector<Matrix6d> poses;  ///< marginal, of the right perturbation of T_map_vehicle
  std::vector<Eigen::Matrix3d> points;  ///< of p_map given the poses; NaN for points not kept
  std::vector<double> scale_sigmas;     ///< 0: fixed
  std::string message;
};

/// Covariances at the state of `problem` (as bundle_adjust left it), counting the observations
/// marked in `inlier` (all, if empty), weighted by the robust loss. Exact marginals by the sparse
/// inverse (Takahashi's recursion) of the reduced system: right where all residuals are
/// independent (cluster_covariance.hpp counts their common errors). Costs as much as a few
/// iterations.
[[nodiscard]] BundleCovariance bundle_covariance(const BundleProblem& problem,
                                                 const std::vector<std::uint8_t>& inlier,
                                                 const BundleOptions& options = {});

/// Marks points that take part: fixed, or seen by two observations that are marked in `active`.
[[nodiscard]] std::vector<std::uint8_t> points_with_two(const BundleProblem& problem,
                                                        const std::vector<std::uint8_t>& active);

}  // namespace roadbook
