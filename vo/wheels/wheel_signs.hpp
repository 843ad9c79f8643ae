#pragma once

#include <vector>

#include "sensors/wheels.hpp"
#include "vo/keyframe_track.hpp"
#include "vo/wheels/time_span.hpp"

namespace roadbook {

/// Signs of wrong wheels in an odometry that used them. It follows the wheels, so that it shows
/// that they are wrong, but not by how much.
struct WheelSigns {
  /// Times [ns] with keyframes whose corners did not agree with any motion near that of the wheels,
  /// or with turns that the cameras alone see otherwise. Ascending, apart from each other.
  std::vector<TimeSpan> spans;
  bool scale = false;  ///< the ground lies at a wrong distance below the cameras

  [[nodiscard]] bool any() const { return scale || !spans.empty(); }
};

/// Looks for signs of wrong wheels. `camera_height_m`: over the ground, by calibration.
[[nodiscard]] WheelSigns find_wheel_signs(const VoResult& odometry,
                                          const WheelOdometry& wheels,
                                          double camera_height_m);

}  // namespace roadbook
