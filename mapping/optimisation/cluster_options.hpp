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

/// An error that all pixels of a camera may share, as a shift of every predicted pixel.
struct CommonError {
  std::vector<Eigen::Vector2d> pixels;  ///< of each observation of the problem [px]
  /// Something else speaks for it, so it counts with at least this size. Otherwise it counts only
  /// if the residuals show it, and with the size that they show.
  bool suspected = true;
};

}  // namespace roadbook
