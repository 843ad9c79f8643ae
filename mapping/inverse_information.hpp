#pragma once

#include <Eigen/LU>

#include "mapping/known_covariance.hpp"

namespace roadbook {

/// The covariance that an information matrix leaves; unknown (NaN) where it is singular.
template <typename Matrix>
[[nodiscard]] Matrix covariance_of_information(const Matrix& information) {
  Eigen::FullPivLU<Matrix> lu(information);
  lu.setThreshold(1e-12);
  if (!lu.isInvertible()) return unknown_covariance<Matrix>();
  return lu.inverse();
}

}  // namespace roadbook
