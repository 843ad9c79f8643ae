#include "mapping/optimisation/covariance.hpp"

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "mapping/known_covariance.hpp"
#include "mapping/optimisation/bundle_adjustment_check.hpp"
#include "mapping/optimisation/bundle_adjustment_system.hpp"
#include "mapping/optimisation/bundle_adjustment_terms.hpp"

namespace roadbook {

std::vector<std::uint8_t> points_with_two(const BundleProblem& problem,
                                          const std::vector<std::uint8_t>& active) {
  std::vector<int> count(problem.points.size(), 0);
  for (std::size_t o = 0; o < active.size(); ++o)
    if (active[o] != 0) ++count[static_cast<std::size_t>(problem.observations[o].point)];
  std::vector<std::uint8_t> kept(problem.points.size());
  for (std::size_t p = 0; p < kept.size(); ++p) kept[p] = problem.points[p].fixed || count[p] >= 2;
  return kept;
}

BundleCovariance bundle_covariance(const BundleProblem& problem,
                                   const std::vector<std::uint8_t>& inlier,
                                   const BundleOptions& options) {
  options.check();
  check_bundle(problem);
  std::vector<std::uint8_t> active = inlier;
  if (active.empty()) active.assign(problem.observations.size(), 1);
  ROADBOOK_ASSERT(active.size() == problem.observations.size());

  BundleCovariance result;
  result.poses.assign(problem.poses.size(), unknown_covariance<Matrix6d>());
  result.points.assign(problem.points.size(), unknown_covariance<Eigen::Matrix3d>());
  result.scale_sigmas.assign(problem.scales.size(), std::numeric_limits<double>::quiet_NaN());
  const BundleLayout layout(problem, options, active, points_with_two(problem, active));
  BundleSystem system(problem, layout, options);
  system.linearise(state_of(problem));
  for (std::size_t p = 0; p < problem.points.size(); ++p) {
    if (layout.point_free[p] == 0) continue;
    Eigen::FullPivLU<Eigen::Matrix3d> lu(system.point_information(p));
    lu.setThreshold(1e-14);
    if (lu.isInvertible()) result.points[p] = lu.inverse();
  }
  BundleStep step;
  if (!system.solve(0.0, step)) {
    result.message = "the normal equations are singular: the gauge is not fixed";
    return result;
  }
  Eigen::MatrixXd scales;
  const std::vector<Matrix6d> poses = system.pose_covariances(scales);
  for (std::size_t i = 0; i < problem.poses.size(); ++i)
    if (layout.variable[i] < 0) result.poses[i].setZero();
  for (std::size_t v = 0; v < poses.size(); ++v)
    result.poses[static_cast<std::size_t>(layout.pose_of[v])] = poses[v];
  Eigen::Index column = 0;
  for (std::size_t s = 0; s < problem.scales.size(); ++s) {
    result.scale_sigmas[s] = 0.0;
    if (problem.scales[s].fixed) continue;
    result.scale_sigmas[s] = std::sqrt(scales(column, column));
    ++column;
  }
  result.usable = true;
  result.message = "relative to the fixed poses";
  return result;
}

}  // namespace roadbook
