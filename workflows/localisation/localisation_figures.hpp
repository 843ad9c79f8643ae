#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "drive/readings.hpp"
#include "mapping/localisation/localise_drive.hpp"

namespace roadbook {

/// Frames in a row without a pose.
struct LostSpan {
  std::int64_t t_begin_ns = 0;  ///< stamp of the first frame
  std::int64_t t_end_ns = 0;    ///< stamp of the last frame
  std::size_t frames = 0;
};

/// Distance of localised poses from the truth, in the vehicle frame of the truth; NaN if no frame
/// was localised.
struct LocalisationTruth {
  static constexpr double kNoFrame = std::numeric_limits<double>::quiet_NaN();
  std::size_t frames = 0;      ///< localised ones with truth
  double median_m = kNoFrame;  ///< of the distance in three dimensions
  double p95_m = kNoFrame;
  double max_m = kNoFrame;
  double along_median_m = kNoFrame;   ///< of the absolute value, along the vehicle's x axis
  double across_median_m = kNoFrame;  ///< the same along its y axis
  double heading_median_rad = kNoFrame;
  double heading_p95_rad = kNoFrame;
  double recall_0_1_m = 0.0;  ///< share of all frames with truth, localised within 0.1 m
  double recall_0_2_m = 0.0;
  double recall_0_5_m = 0.0;
  /// Mean of xi^T C^-1 xi / 6 over the localised frames: 1 if the covariances hold. Empty without
  /// covariances.
  std::optional<double> nees;
  /// Share of localised frames with the true place in the 95 % ellipse of x and y. Empty likewise.
  std::optional<double> in_ellipse;
};

struct LocalisationFigures {
  std::size_t frames = 0;
  std::size_t localised = 0;  ///< the relocalised ones included
  std::size_t relocalised = 0;
  std::size_t predicted = 0;
  std::vector<LostSpan> lost;
  std::optional<double> inliers_median;  ///< of the localised frames
  std::optional<double> inliers_p5;
  std::optional<double> cpu_ms_median;
  std::optional<double> cpu_ms_p99;
  std::optional<double> jump_median_m;  ///< pose against the wheels' motion since the frame before
  std::optional<double> jump_p999_m;
  std::optional<LocalisationTruth> truth;
};

/// The pose at a stamp, interpolated between poses at most 0.5 s apart; empty outside them.
/// `poses` ascend in time.
[[nodiscard]] std::optional<Eigen::Isometry3d> true_pose_at(const std::vector<TimedPose>& poses,
                                                            std::int64_t t_ns);

/// Counts frames and takes the quantiles over them. Values that no frame has are empty.
[[nodiscard]] LocalisationFigures localisation_figures(const std::vector<TimedFrame>& frames);

/// Distance [m] of each frame's pose from the true one, predicted poses included; NaN where there
/// is no pose or no truth.
[[nodiscard]] std::vector<double> localisation_errors(const std::vector<TimedFrame>& frames,
                                                      const std::vector<TimedPose>& truth,
                                                      const Eigen::Isometry3d& T_map_world);

/// Compares localised poses with the true poses of the drive, interpolated in time. `T_map_world`:
/// the pose of the truth's world in the map. Empty if no frame has truth.
[[nodiscard]] std::optional<LocalisationTruth> localisation_truth(
    const std::vector<TimedFrame>& frames,
    const std::vector<TimedPose>& truth,
    const Eigen::Isometry3d& T_map_world);

}  // namespace roadbook
