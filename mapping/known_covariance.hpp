#pragma once

#include <Eigen/Core>
#include <limits>

namespace roadbook {

// An unknown covariance is a matrix of NaN in memory and NULL in the map file; it is never zero.
// Zero means exact: the pose that holds the gauge.

/// An unknown covariance.
template <typename Matrix>
[[nodiscard]] Matrix unknown_covariance() {
  return Matrix::Constant(std::numeric_limits<double>::quiet_NaN());
}

/// False for a covariance with a value that is not finite: a consumer must refuse it.
template <typename Derived>
[[nodiscard]] bool is_known(const Eigen::MatrixBase<Derived>& covariance) {
  return covariance.allFinite();
}

}  // namespace roadbook
