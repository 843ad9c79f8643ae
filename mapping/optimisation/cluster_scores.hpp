#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "mapping/optimisation/bundle_adjustment_system.hpp"

namespace roadbook {

// Scores (gradients of the cost) of one landmark with the landmark eliminated, for covariances that
// count the common error of residuals (cluster_covariance.hpp).

/// The linearised terms of a landmark, each times the root of its robust weight.
struct PointTerms {
  struct Term {
    int variable = -1;  ///< pose variable; -1: fixed
    int pose = 0;
    int camera = 0;
    int observation = -1;      ///< of the problem; -1: a ground height
    double root_per_px = 0.0;  ///< root of the robust weight over the pixel's standard deviation
    Matrix26d J_pose;
    Matrix23d J_point;
    Eigen::Vector2d r;
  };
  std::vector<Term> terms;
  Eigen::Matrix3d V_inverse = Eigen::Matrix3d::Zero();  ///< zero: the terms do not fix the point
};

[[nodiscard]] PointTerms point_terms(const BundleProblem& problem,
                                     const BundleLayout& layout,
                                     const BundleOptions& options,
                                     const BundleState& state,
                                     std::size_t point);

/// Share of the landmark's residuals that the poses absorb, 0 to 1: their mean leverage.
/// `system`: after pose_covariances.
[[nodiscard]] double leverage_of(const PointTerms& point, BundleSystem& system);

/// Changes of a landmark's residuals, two rows for each term and one column for each case, after
/// the landmark has moved to fit them: E - J_point (J_point^T J_point)^-1 J_point^T E.
[[nodiscard]] BlockCholesky::Panel after_landmark(const PointTerms& point,
                                                  const BlockCholesky::Panel& residuals);

/// Adds J_pose^T E to the rows of the poses, where E are changes of the landmark's residuals.
void add_scores(const PointTerms& point,
                const BlockCholesky::Panel& residuals,
                BlockCholesky::Panel& poses);

}  // namespace roadbook
