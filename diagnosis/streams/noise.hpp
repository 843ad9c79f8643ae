#pragma once

#include <array>
#include <vector>

#include "diagnosis/streams/observations.hpp"

namespace roadbook {

/// Standard deviations that the fit weighs its rows with; estimated, not believed.
struct MotionNoise {
  // Readings.
  double wheel_angle_rad = 1e-3;                 ///< of one wheel
  double steering_rad = 2e-3;                    ///< of a window's mean
  double gyro_rad_s = 1e-3;                      ///< of a window's mean
  std::array<double, 3> pose{0.02, 0.02, 2e-3};  ///< along, across [m], heading [rad]
  // Walks: what the readings cannot tell from motion.
  double distance_per_sqrt_m = 0.01;
  double heading_per_sqrt_m = 0.003;
  double creep_per_sqrt_m = 2e-4;  ///< sideways
  // Second differences from knot to knot: how rough the driving is.
  double speed_m_s = 0.02;
  double yaw_rad_s = 0.01;
  /// A gyro whose readings go together is followed by the trajectory: what it errs by for long
  /// would count as motion and its noise as next to nothing, so that is estimated to be this at
  /// least.
  double least_gyro_rad_s = 0.0;

  /// No reference of a moving car is believed beyond these, nor is the motion model: poses that
  /// are exact (of a simulation) count as this uncertain.
  static constexpr double kLeastPosition = 5e-3;  // [m]
  static constexpr double kLeastHeading = 5e-4;   // [rad]
  [[nodiscard]] bool poses_are_exact() const { return pose[0] <= kLeastPosition; }

  /// Of one row of a channel that is read directly (not wheels).
  [[nodiscard]] double sigma(Channel channel) const;
  [[nodiscard]] double& sigma(Channel channel);
};

/// Where estimation starts: the sensors' stated noise; of means, the scatter within their windows.
[[nodiscard]] MotionNoise stated_noise(const Observations& obs);

/// The same with far rougher driving. Driving is smooth for long and rough at times; where a prior
/// of the mean roughness is wrong, its error shows as causes.
[[nodiscard]] MotionNoise loosened(const MotionNoise& noise);

}  // namespace roadbook
