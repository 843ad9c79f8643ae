#pragma once

#include <array>
#include <vector>

#include "diagnosis/streams/observations.hpp"

namespace roadbook {

/// Standard deviations of the rows and of the process noise. They are estimated from the drive;
/// stated values are only the start.
struct MotionNoise {
  // Readings.
  double wheel_angle_rad = 1e-3;                 ///< of one wheel [rad]
  double steering_rad = 2e-3;                    ///< of a window's mean
  double gyro_rad_s = 1e-3;                      ///< of a window's mean
  std::array<double, 3> pose{0.02, 0.02, 2e-3};  ///< along, across [m], heading [rad]
  // Random walks of the wheels and of lateral slip.
  double distance_per_sqrt_m = 0.01;
  double heading_per_sqrt_m = 0.003;
  double creep_per_sqrt_m = 2e-4;  ///< lateral slip
  // Process noise: second differences from knot to knot.
  double speed_m_s = 0.02;
  double yaw_rad_s = 0.01;
  /// Lower bound of the gyro noise. The trajectory follows a gyro with autocorrelated errors; its
  /// slow errors would count as motion and its estimated noise would be far too small.
  double least_gyro_rad_s = 0.0;

  /// Lower bounds of the pose noise. No reference of a moving car, and no motion model, is better.
  /// Exact poses of a simulation get this uncertainty.
  static constexpr double kLeastPosition = 5e-3;  // [m]
  static constexpr double kLeastHeading = 5e-4;   // [rad]
  [[nodiscard]] bool poses_are_exact() const { return pose[0] <= kLeastPosition; }

  /// Standard deviation of one row of a channel that is measured directly (not wheels).
  [[nodiscard]] double sigma(Channel channel) const;
  [[nodiscard]] double& sigma(Channel channel);
};

/// Starting values: the stated noise of the sensors; for means of windows the scatter within them.
[[nodiscard]] MotionNoise stated_noise(const Observations& obs);

/// The same with six times rougher driving. Driving is smooth most of the time and rough at times.
/// A prior of the mean roughness is wrong at those times, and its error would show as effects.
[[nodiscard]] MotionNoise loosened(const MotionNoise& noise);

}  // namespace roadbook
