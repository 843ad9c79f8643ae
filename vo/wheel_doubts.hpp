#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sensors/wheels.hpp"
#include "vo/keyframe_track.hpp"

namespace roadbook {

// Comparison of the wheels with an odometry of the cameras, over windows of a few keyframes.

/// A time in which the wheels contradict the cameras by more than four standard deviations.
struct WheelDoubt {
  std::int64_t t_begin_ns = 0;
  std::int64_t t_end_ns = 0;
  double turn_rad = 0.0;  ///< wheels less cameras
  double way_m = 0.0;     ///< wheels less cameras, in the wheels' length unit
};

struct WheelComparison {
  std::vector<WheelDoubt> doubts;  ///< ascending, apart from each other
  double compared_m = 0.0;         ///< way over which the cameras know the motion
  double doubted_m = 0.0;          ///< of it
  double compared_turn_rad = 0.0;  ///< turn over which the cameras know the motion
  double doubted_turn_rad = 0.0;   ///< of it
  /// Turn by the wheels over turn by the cameras: the median, by turn. Empty without turns.
  std::optional<double> turn_factor;
};

/// Compares the wheels with the motions of `odometry`. `knows_scale`: its lengths are metres of the
/// wheels (it used them); else only changes of the ratio of lengths are seen.
[[nodiscard]] WheelComparison compare_wheels(const VoResult& odometry,
                                             const WheelOdometry& wheels,
                                             bool knows_scale);

/// Length by the cameras' height over the ground over length in `odometry`: 1 if the scale is
/// right. Empty if too little ground is seen.
[[nodiscard]] std::optional<double> ground_factor(const VoResult& odometry, double camera_height_m);

}  // namespace roadbook
