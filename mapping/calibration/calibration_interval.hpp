#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstdint>
#include <vector>

#include "mapping/calibration/calibration_problem.hpp"

namespace roadbook {

/// Estimate of the columns from a linearised problem, with poses and points eliminated.
struct ColumnEstimate {
  bool usable = false;
  Eigen::VectorXd step;         ///< Gauss-Newton step of the columns; near zero at the optimum
  Eigen::MatrixXd covariance;   ///< cluster-robust; zero for held columns
  Eigen::MatrixXd score_parts;  ///< influence of each cluster, then of each prior (rows)
};

/// `held`: columns without a derivative. `priors`: standard deviations of all columns before the
/// drive, which are residuals of `linear` too.
[[nodiscard]] ColumnEstimate estimate_columns(const CalibrationProblem::Linear& linear,
                                              const std::vector<std::uint8_t>& held,
                                              const Eigen::VectorXd& priors);

/// Half width of the 95 % interval of the linear form `a` of the columns: Student's quantile for
/// the effective number of clusters (Satterthwaite), times the standard error.
[[nodiscard]] double half_width_95(const ColumnEstimate& estimate, const Eigen::VectorXd& a);

}  // namespace roadbook
