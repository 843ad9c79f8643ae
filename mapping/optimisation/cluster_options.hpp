#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace roadbook {

/// How cluster_covariance counts common errors.
struct ClusterOptions {
  int cases = 128;  ///< draws; a multiple of 64
  double cell_m = 2.0;
  int sampled_poses = 6;    ///< from which the effective clusters are counted
  std::uint64_t seed = 20;  ///< of the signs

  /// Throws InvalidOption.
  void check() const;
};

/// With which size a common error counts; `pixels` are of size 1.
enum class CommonErrorSize {
  kAtLeast,  ///< 1, or more where the residuals say so: something else speaks for it
  kIfShown,  ///< that of the residuals, if they show it
  kKnown,    ///< 1: the residuals cannot tell
};

/// An error that all pixels of a camera may share, as a shift of every predicted pixel.
struct CommonError {
  std::vector<Eigen::Vector2d> pixels;  ///< of each observation of the problem [px]
  CommonErrorSize size = CommonErrorSize::kAtLeast;
};

}  // namespace roadbook
