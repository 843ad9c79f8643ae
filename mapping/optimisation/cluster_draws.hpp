#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "mapping/optimisation/bundle_adjustment_system.hpp"
#include "mapping/optimisation/cluster_options.hpp"

namespace roadbook {

/// A linearised problem and what its covariances need; parts of cluster_covariance.
struct ClusterData {
  const BundleProblem& problem;
  const BundleLayout& layout;
  const BundleOptions& options;
  const ClusterOptions& clusters;
  const BundleState& state;
  std::vector<double> leverage;  ///< of each point
};

/// The cluster of a camera (kWheels: the wheels) at the place of a pose.
inline constexpr int kWheels = -2;
[[nodiscard]] std::uint64_t place_of(const ClusterData& data, int pose, int camera);

/// The score of a motion's residual, J^T Omega r, in six rows for each end and one for the scale,
/// and the roots J^T U^T of its stated noise, Omega = U^T U. A residual beyond the loss width loses
/// weight.
struct MotionScore {
  int from = -1;  ///< pose variable; -1: fixed
  int to = -1;
  int scale = -1;  ///< row of the free scales; -1: none
  Eigen::Matrix<double, 13, 1> score;
  Eigen::Matrix<double, 13, 6> root;
};
[[nodiscard]] MotionScore motion_score(const ClusterData& data, const MotionConstraint& motion);

/// Rows of free scales of the problem; -1: fixed.
[[nodiscard]] std::vector<int> free_scales(const BundleProblem& problem);

struct DrawnCovariance {
  std::vector<Matrix6d> poses;  ///< of each pose variable
  std::vector<double> scale_variances;
};

/// C_L plus the positive part of C_P - C_LP (cluster_covariance.hpp). `system`: just solved with
/// lambda 0.
[[nodiscard]] DrawnCovariance drawn_covariance(const ClusterData& data, const BundleSystem& system);

}  // namespace roadbook
