#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace roadbook {

// Comparison of a trajectory with a reference: association by time, alignment, absolute error.

/// p_a = scale * R * p_b + t.
struct Similarity {
  double scale = 1.0;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t = Eigen::Vector3d::Zero();
  bool unique = false;  ///< false: fewer than three points, or all on one line

  [[nodiscard]] Eigen::Vector3d operator*(const Eigen::Vector3d& p) const {
    return scale * (R * p) + t;
  }
};

/// Least-squares alignment of `b` to `a`, point by point (Umeyama, PAMI 1991, eqs. 40-42); rigid if
/// `with_scale` is false. Sequences of equal length; empty ones give the identity.
[[nodiscard]] Similarity align(std::span<const Eigen::Vector3d> a,
                               std::span<const Eigen::Vector3d> b,
                               bool with_scale);

/// Absolute trajectory error: distances [m] after alignment.
struct TrajectoryError {
  std::size_t count = 0;
  double median_m = 0.0;
  double p95_m = 0.0;
  double rmse_m = 0.0;
  double max_m = 0.0;
  Similarity T_reference_estimate;
};
/// Aligns `estimate` to `reference` (positions [m], pairs in order) and returns the distances.
[[nodiscard]] TrajectoryError trajectory_error(std::span<const Eigen::Vector3d> reference,
                                               std::span<const Eigen::Vector3d> estimate,
                                               bool with_scale);

/// Returns pairs (index in a, index in b) of stamps [ns] at most `tolerance_ns` apart. Each stamp
/// of `a` gets the nearest of `b`. Each stamp of `b` is used at most once; the nearer stamp of `a`
/// wins, then the earlier. Both inputs ascend.
[[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> associate_stamps(
    std::span<const std::int64_t> a_ns,
    std::span<const std::int64_t> b_ns,
    std::int64_t tolerance_ns);

}  // namespace roadbook
