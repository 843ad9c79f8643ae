#include "diagnosis/numerics/correlation_about_line.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace roadbook {
namespace {

// Covariance of deviations from a line through `count` readings of AR(1) noise of unit variance.
Eigen::MatrixXd about_line(double correlation, std::size_t count) {
  const auto n = static_cast<Eigen::Index>(count);
  Eigen::MatrixXd covariance(n, n);
  Eigen::MatrixXd line(n, 2);
  for (Eigen::Index i = 0; i < n; ++i) {
    line.row(i) << 1.0, static_cast<double>(i);
    for (Eigen::Index j = 0; j < n; ++j)
      covariance(i, j) = std::pow(correlation, static_cast<double>(std::abs(i - j)));
  }
  const Eigen::MatrixXd left = Eigen::MatrixXd::Identity(n, n) -
                               line * (line.transpose() * line).inverse() * line.transpose();
  return left * covariance * left;
}

}  // namespace

CorrelatedFreedom freedom_of_correlated(double correlation, std::size_t count) {
  const double white = static_cast<double>(count) - 2.0;
  const Eigen::MatrixXd alone = about_line(0.0, count);
  const Eigen::MatrixXd S = about_line(std::max(correlation, 0.0), count);
  const double freedom = S.trace() * S.trace() / S.squaredNorm();
  CorrelatedFreedom left{freedom / white, {}};
  // A line is symmetric.
  for (std::size_t i = 0; i < (count + 1) / 2; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    left.leverages.push_back(alone(at, at) * freedom / S.trace());
  }
  return left;
}

double square_about_line(double correlation, std::size_t count) {
  return about_line(correlation, count).trace();
}

double ratio_of_correlation(double correlation, std::size_t count) {
  const Eigen::MatrixXd S = about_line(correlation, count);
  return S.diagonal(1).sum() / S.trace();
}

double correlation_of_ratio(double ratio, std::size_t count) {
  double low = 0.0;
  double high = 0.99;
  if (ratio <= ratio_of_correlation(low, count)) return low;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (ratio_of_correlation(middle, count) < ratio ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace roadbook
