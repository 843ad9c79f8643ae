#pragma once

#include <optional>
#include <vector>

#include "diagnosis/streams/streams.hpp"

namespace roadbook {

/// Motion of the vehicle at one time, smoothed over reference poses.
struct PoseMotion {
  double x = 0.0, y = 0.0, heading = 0.0;
  double speed = 0.0;                 ///< forward [m/s]
  double acceleration = 0.0;          ///< [m/s^2]
  double yaw_rate = 0.0;              ///< [rad/s]
  double lateral_acceleration = 0.0;  ///< speed times yaw rate [m/s^2]
};

/// Half width [s] of the smoothing window that gives the acceleration to 0.07 m/s^2, between 0.25
/// and 0.7 s. A wider window blurs changes of the acceleration. The noise of the poses is estimated
/// from third differences. The second derivative of a least-squares parabola has 720 times the
/// variance of a pose, divided by the number of poses and the fourth power of the window width.
[[nodiscard]] double half_window_of(const std::vector<PoseSample>& poses);

/// Smooths poses by least-squares fits within `half_s` of each requested time: parabolas for x and
/// y, a line for the heading.
class PoseSmoother {
 public:
  explicit PoseSmoother(const std::vector<PoseSample>& poses, double half_s = 0.7);
  /// Motion at `t_s`; no value outside the poses or in a gap. Cheapest if the times of successive
  /// calls ascend.
  [[nodiscard]] std::optional<PoseMotion> at(double t_s);

 private:
  std::vector<PoseSample> poses_;  ///< headings unwrapped
  double half_s_;
  std::size_t first_ = 0;
};

}  // namespace roadbook
