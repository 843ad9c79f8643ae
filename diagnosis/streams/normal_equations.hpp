#pragma once

#include <Eigen/Core>
#include <array>

#include "diagnosis/inference/innovations.hpp"
#include "diagnosis/streams/observations.hpp"

namespace roadbook {

/// Of the columns behind the residual: information, score, and the residual's square.
struct Normal {
  Eigen::MatrixXd F;
  Eigen::VectorXd u;
  double squares = 0.0;
  std::array<Eigen::MatrixXd, kChannels> by_channel;
};

/// Of the first `count` columns.
[[nodiscard]] Normal normal_equations(const Innovations& in, std::size_t count);

}  // namespace roadbook
