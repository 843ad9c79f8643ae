#pragma once

#include <Eigen/Core>
#include <array>

#include "diagnosis/inference/innovations.hpp"
#include "diagnosis/streams/observations.hpp"

namespace roadbook {

/// Normal equations of the columns behind the residual: information matrix F, score u and the
/// squared residual.
struct Normal {
  Eigen::MatrixXd F;
  Eigen::VectorXd u;
  double squares = 0.0;
  std::array<Eigen::MatrixXd, kChannels> by_channel;
};

/// Normal equations of the first `count` columns.
[[nodiscard]] Normal normal_equations(const Innovations& in, std::size_t count);

}  // namespace roadbook
