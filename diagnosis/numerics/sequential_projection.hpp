#pragma once

#include <Eigen/Core>
#include <vector>

namespace roadbook {

/// Projects unknowns with a Gaussian prior out of scalar measurements, one after another. Each
/// measurement leaves its Kalman innovation, white and of unit variance, for any number of right-
/// hand sides at once.
class SequentialProjection {
 public:
  /// `variance`: prior of each unknown, whitened like the rows.
  SequentialProjection(const Eigen::VectorXd& variance, Eigen::Index sides)
      : covariance_(variance.asDiagonal()), mean_(Eigen::MatrixXd::Zero(variance.size(), sides)) {}

  /// The row `unknowns` of the measurement and its sides, noise 1. Returns the innovations'
  /// variance before they were scaled to 1.
  double next(const Eigen::VectorXd& unknowns, Eigen::Ref<Eigen::RowVectorXd> sides) {
    const Eigen::VectorXd gain = covariance_ * unknowns;
    const double variance = 1.0 + unknowns.dot(gain);
    const Eigen::RowVectorXd surprise = sides - unknowns.transpose() * mean_;
    mean_.noalias() += gain * surprise / variance;
    covariance_.noalias() -= gain * gain.transpose() / variance;
    sides = surprise / std::sqrt(variance);
    return variance;
  }

 private:
  Eigen::MatrixXd covariance_;
  Eigen::MatrixXd mean_;
};

}  // namespace roadbook
