#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/streams/streams.hpp"

namespace roadbook {

/// Means of all axes of an IMU over a short time, and the motion of the vehicle then.
struct TiltWindow {
  double t_s = 0.0;
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();   ///< read [rad/s]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< read [m/s^2]
  Eigen::Vector3d up{0.0, 0.0, 1.0};  ///< vertical of the reference, in the vehicle frame
  /// Turn rates [rad/s] by which the reference's attitude changes. Its turn about the vertical is
  /// not part of them.
  Eigen::Vector3d own_rate = Eigen::Vector3d::Zero();
  double speed = 0.0;         ///< [m/s] of the reference
  double acceleration = 0.0;  ///< [m/s^2] of the reference
};

/// Which axes have readings that vary: an axis of constant readings was not measured.
struct TiltAxes {
  bool rates = false;   ///< roll and pitch rate
  bool forces = false;  ///< acceleration with gravity, forward and to the left
};

/// Windows of `step_s` that are full of readings and lie within the poses. Empty where the streams
/// have no IMU of three axes, or where samples are not finite or not in order.
[[nodiscard]] std::vector<TiltWindow> tilt_windows(const MotionStreams& streams, double step_s);
[[nodiscard]] TiltAxes tilt_axes(const std::vector<ImuSample>& imu);

}  // namespace roadbook
