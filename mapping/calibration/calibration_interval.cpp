#include "mapping/calibration/calibration_interval.hpp"

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "base/index.hpp"

namespace roadbook {

ColumnEstimate estimate_columns(const CalibrationProblem::Linear& linear,
                                const std::vector<std::uint8_t>& held,
                                const Eigen::VectorXd& priors) {
  ColumnEstimate estimate;
  const Eigen::SparseMatrix<double>& A = linear.others;
  Eigen::SparseMatrix<double> normal = A.transpose() * A;
  for (Eigen::Index i = 0; i < normal.rows(); ++i) normal.coeffRef(i, i) += 1e-9;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(normal);
  if (solver.info() != Eigen::Success) return estimate;
  const Eigen::MatrixXd imitated = solver.solve(A.transpose() * linear.columns);
  const Eigen::VectorXd absorbed = solver.solve(A.transpose() * linear.residuals);
  const Eigen::MatrixXd columns = linear.columns - A * imitated;  // J~
  const Eigen::VectorXd residuals = linear.residuals - A * absorbed;

  const Eigen::Index count = columns.cols();
  Eigen::MatrixXd H = columns.transpose() * columns;
  for (Eigen::Index i = 0; i < count; ++i)
    if (held[at(static_cast<int>(i))] != 0) H(i, i) = 1.0;
  const Eigen::LDLT<Eigen::MatrixXd> inverse(H);
  Eigen::MatrixXd scores = Eigen::MatrixXd::Zero(linear.cluster_count, count);
  Eigen::VectorXd score = Eigen::VectorXd::Zero(count);
  for (Eigen::Index row = 0; row < residuals.size(); ++row) {
    const Eigen::RowVectorXd part = residuals[row] * columns.row(row);
    score += part;
    const int cluster = linear.clusters[at(static_cast<int>(row))];
    if (cluster >= 0) scores.row(cluster) += part;
  }
  estimate.step = -inverse.solve(score);
  // Away from the optimum, what all clusters have in common is the step, not noise.
  const Eigen::RowVectorXd mean = scores.colwise().mean();
  scores.rowwise() -= mean;
  const auto clusters = static_cast<double>(linear.cluster_count);
  const double free = clusters - static_cast<double>(std::count(held.begin(), held.end(), 0));
  if (!(free > 1.0)) return estimate;
  Eigen::MatrixXd parts(scores.rows() + count, count);
  parts << std::sqrt(clusters / free) * scores, Eigen::MatrixXd(priors.cwiseInverse().asDiagonal());
  for (Eigen::Index i = 0; i < count; ++i)
    if (held[at(static_cast<int>(i))] != 0) parts.col(i).setZero();
  estimate.score_parts = inverse.solve(parts.transpose()).transpose();
  estimate.covariance = estimate.score_parts.transpose() * estimate.score_parts;
  estimate.usable = estimate.step.allFinite() && estimate.covariance.allFinite();
  return estimate;
}

double half_width_95(const ColumnEstimate& estimate, const Eigen::VectorXd& a) {
  constexpr double kNormal = 1.959964;
  const Eigen::VectorXd squares = (estimate.score_parts * a).cwiseAbs2();
  const double variance = squares.sum();
  if (!(variance > 0.0)) return 0.0;
  const double freedom = std::max(1.0, variance * variance / squares.squaredNorm());
  // Cornish and Fisher's expansion of Student's quantile.
  const double z = kNormal;
  const double quantile =
      z + (z * z * z + z) / (4.0 * freedom) +
      (5.0 * std::pow(z, 5) + 16.0 * z * z * z + 3.0 * z) / (96.0 * freedom * freedom);
  return quantile * std::sqrt(variance);
}

}  // namespace roadbook
