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

/// Adds J^T (E - J_point (J_point^T J_point)^-1 J_point^T E) to the rows of the poses, where E are
/// residuals: two rows for each term, one column for each case.
void add_reduced_scores(const PointTerms& point,
                        const BlockCholesky::Panel& residuals,
                        BlockCholesky::Panel& poses);

}  // namespace roadbook
