#include "mapping/optimisation/cluster_covariance.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/require_option.hpp"
#include "mapping/known_covariance.hpp"
#include "mapping/optimisation/bundle_adjustment_check.hpp"
#include "mapping/optimisation/cluster_draws.hpp"
#include "mapping/optimisation/cluster_scores.hpp"
#include "mapping/optimisation/common_errors.hpp"
#include "mapping/optimisation/effective_clusters.hpp"
#include "mapping/union_find.hpp"

namespace roadbook {
namespace {

// Poses that landmarks or motions tie together.
std::vector<int> tied_poses(const BundleProblem& problem, const BundleLayout& layout) {
  UnionFind sets(problem.poses.size());
  for (std::size_t p = 0; p + 1 < layout.term_begin.size(); ++p) {
    if (layout.point_free[p] == 0) continue;
    for (std::size_t t = layout.term_begin[p] + 1; t < layout.term_begin[p + 1]; ++t)
      sets.join(layout.terms[t].pose, layout.terms[t - 1].pose);
  }
  for (const MotionConstraint& m : problem.motions) sets.join(m.from, m.to);
  return sets.numbers();
}

// Gives the poses of a problem back as fixed or free as they were. A copy of the problem of a large
// map would not fit beside its factor.
class FixedPoses {
 public:
  explicit FixedPoses(BundleProblem& problem) : problem_(problem) {
    for (const BundlePose& pose : problem.poses) fixed_.push_back(pose.fixed);
  }
  ~FixedPoses() {
    for (std::size_t i = 0; i < fixed_.size(); ++i) problem_.poses[i].fixed = fixed_[i];
  }
  FixedPoses(const FixedPoses&) = delete;
  FixedPoses& operator=(const FixedPoses&) = delete;

 private:
  BundleProblem& problem_;
  std::vector<bool> fixed_;
};

// Fixes the first pose of each piece. A set of poses that is not tied to it is fixed too, so that
// the system can be solved, and its poses are `lost`.
std::vector<std::uint8_t> fix_gauges(const std::vector<int>& tied,
                                     const std::vector<int>& piece,
                                     BundleProblem& problem) {
  std::map<int, int> gauge;  // of each piece: the set of its first pose
  std::map<int, bool> held;  // sets with a fixed pose
  std::vector<std::uint8_t> lost(problem.poses.size(), 0);
  for (std::size_t i = 0; i < problem.poses.size(); ++i) {
    if (gauge.emplace(piece[i], tied[i]).second) {
      problem.poses[i].fixed = true;
      held[tied[i]] = true;
    }
    lost[i] = gauge.at(piece[i]) != tied[i];
    if (lost[i] && !held[tied[i]]) problem.poses[i].fixed = held[tied[i]] = true;
  }
  return lost;
}

double chi2_of(const BundleProblem& problem,
               const BundleLayout& layout,
               const BundleOptions& options,
               const BundleState& state) {
  double sum = 0.0;
  double freedom = -3.0 * static_cast<double>(layout.pose_of.size());  // motions give the others
  for (std::size_t p = 0; p < problem.points.size(); ++p) {
    const PointTerms point = point_terms(problem, layout, options, state, p);
    if (point.terms.empty()) continue;
    freedom -= 3.0;
    for (const PointTerms::Term& t : point.terms) {
      if (t.camera == BundleTerm::kGround) continue;
      sum += t.r.squaredNorm();
      freedom += 2.0;
    }
  }
  return freedom > 1.0 ? sum / freedom : 1.0;
}

std::vector<double> leverages(const BundleProblem& problem,
                              const BundleLayout& layout,
                              const BundleOptions& options,
                              const BundleState& state,
                              BundleSystem& system) {
  std::vector<double> leverage(problem.points.size(), 0.0);
  parallel_for_small(leverage.size(), options.num_threads, [&](std::size_t p) {
    const PointTerms point = point_terms(problem, layout, options, state, p);
    if (!point.terms.empty()) leverage[p] = leverage_of(point, system);
  });
  return leverage;
}

// The least matrix that is not below A or B in any direction.
Matrix6d larger_of(const Matrix6d& A, const Matrix6d& B) {
  const Eigen::LLT<Matrix6d> llt(A);
  if (llt.info() != Eigen::Success) return A;
  const Matrix6d inverse = llt.matrixL().solve(Matrix6d::Identity());
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(inverse * B * inverse.transpose());
  const Matrix6d axes = Matrix6d(llt.matrixL()) * solver.eigenvectors();
  const Vector6d sizes = solver.eigenvalues().cwiseMax(1.0);
  return axes * sizes.asDiagonal() * axes.transpose();
}

// Covariance of a normal distribution whose 95 % region of a pose is as large as Hotelling's for
// six dimensions and that many degrees of freedom: the ratio of both is near n / (n - 9). A
// position, with three, would need n / (n - 5); then the regions of all six held 86 % of the true
// poses instead of 92 % (mean of eight simulated drives; positions 98 % and 99 %).
double few_clusters_factor(double clusters) {
  constexpr double kFewest = 14.0;
  const double n = std::max(kFewest, clusters);
  return n / (n - 9.0);
}

}  // namespace

void ClusterOptions::check() const {
  require_option(cases >= 64 && cases % 64 == 0, "cases", cases, "a multiple of 64");
  require_option(cell_m > 0.0, "cell_m", cell_m, "above 0");
  require_option(sampled_poses >= 1, "sampled_poses", sampled_poses, "at least 1");
}

ClusterCovariance cluster_covariance(BundleProblem& problem,
                                     const std::vector<std::uint8_t>& inlier,
                                     const std::vector<int>& piece,
                                     const BundleOptions& options,
                                     const ClusterOptions& clusters,
                                     const std::vector<CommonError>& suspected) {
  options.check();
  clusters.check();
  check_bundle(problem);
  std::vector<std::uint8_t> active = inlier;
  if (active.empty()) active.assign(problem.observations.size(), 1);
  ROADBOOK_ASSERT(active.size() == problem.observations.size());
  ROADBOOK_ASSERT(piece.size() == problem.poses.size());

  ClusterCovariance result;
  result.poses.assign(problem.poses.size(), unknown_covariance<Matrix6d>());
  result.scale_sigmas.assign(problem.scales.size(), std::numeric_limits<double>::quiet_NaN());
  const std::vector<std::uint8_t> kept = points_with_two(problem, active);
  const std::vector<int> tied = tied_poses(problem, BundleLayout(problem, options, active, kept));
  const FixedPoses as_given(problem);
  const std::vector<std::uint8_t> lost = fix_gauges(tied, piece, problem);
  const BundleLayout layout(problem, options, active, kept);
  const BundleState state = state_of(problem);
  BundleSystem system(problem, layout, options);
  system.linearise(state);
  system.forget_jacobians();
  BundleStep step;
  Eigen::MatrixXd scales;
  if (!system.solve(0.0, step)) {
    result.message = "the normal equations are singular: the gauge is not fixed";
    return result;
  }
  const std::vector<Matrix6d> by_pixels = system.pose_covariances(scales);
  const double chi2 = chi2_of(problem, layout, options, state);
  const ClusterData data{problem,  layout, options,
                         clusters, state,  leverages(problem, layout, options, state, system)};
  if (!system.solve(0.0, step)) return result;  // the inverse took the factor's place
  DrawnCovariance drawn = drawn_covariance(data, system);
  result.effective_clusters = effective_clusters(data, system, drawn.poses);
  const double factor = few_clusters_factor(result.effective_clusters);
  const std::vector<CommonMove> moves = moves_of(data, system, suspected);
  for (std::size_t i = 0; i < problem.poses.size(); ++i) {
    if (lost[i] != 0) continue;
    const int v = layout.variable[i];
    if (v < 0) {
      result.poses[i].setZero();
      continue;
    }
    result.poses[i] = larger_of(factor * drawn.poses[at(v)], chi2 * by_pixels[at(v)]);
    for (const CommonMove& move : moves) {
      const Vector6d x = move.poses.segment<6>(row_of(at(v)));
      result.poses[i].noalias() += x * x.transpose();
    }
    if (!result.poses[i].allFinite()) result.poses[i] = unknown_covariance<Matrix6d>();
  }
  std::size_t row = 0;
  for (std::size_t s = 0; s < problem.scales.size(); ++s) {
    result.scale_sigmas[s] = 0.0;
    if (problem.scales[s].fixed) continue;
    double variance = factor * drawn.scale_variances[row];
    for (const CommonMove& move : moves) {
      const double x = move.scales[static_cast<Eigen::Index>(row)];
      variance += x * x;
    }
    result.scale_sigmas[s] = std::sqrt(variance);
    ++row;
  }
  result.usable = true;
  result.message = "relative to the first pose of each piece";
  return result;
}

}  // namespace roadbook
