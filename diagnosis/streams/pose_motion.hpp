#pragma once

#include <optional>
#include <vector>

#include "diagnosis/streams/streams.hpp"

namespace roadbook {

/// Motion of the vehicle at one moment, smoothed over reference poses.
struct PoseMotion {
  double x = 0.0, y = 0.0, heading = 0.0;
  double speed = 0.0;                 ///< forward [m/s]
  double acceleration = 0.0;          ///< [m/s^2]
  double yaw_rate = 0.0;              ///< [rad/s]
  double lateral_acceleration = 0.0;  ///< speed times yaw rate [m/s^2]
};

/// Half of the time [s] over which poses tell the acceleration to 0.07 m/s^2 by their scatter, as
/// third differences show it; 0.25 to 0.7 s. Longer than needed blurs how it changes: a
/// least-squares parabola's second derivative has a variance of 720 times the poses' over count and
/// the fourth power of the span.
[[nodiscard]] double half_window_of(const std::vector<PoseSample>& poses);

/// Parabolas of x, y and a line of heading, least squares over the poses within `half_s` of each
/// asked time.
class PoseSmoother {
 public:
  explicit PoseSmoother(const std::vector<PoseSample>& poses, double half_s = 0.7);
  /// Times should ascend from call to call (cost). Nothing outside the poses or in a gap.
  [[nodiscard]] std::optional<PoseMotion> at(double t_s);

 private:
  std::vector<PoseSample> poses_;  ///< headings unwrapped
  double half_s_;
  std::size_t first_ = 0;
};

}  // namespace roadbook
