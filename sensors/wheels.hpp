#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "base/se3.hpp"

namespace roadbook {

// Wheel odometry: the planar motion of a car from its wheel readings, with covariance.

/// Calibration and noise of the wheels (sensor.yaml of wheels0).
struct WheelModel {
  double radius_left_m = 0.3;
  double radius_right_m = 0.3;
  double track_width_m = 1.5;
  double wheelbase_m = 2.6;
  double steering_ratio = 1.0;  ///< steering-wheel angle / road-wheel angle
  double ticks_per_turn = 0.0;  ///< for tick columns; 0: none
  double wraps_at = 0.0;        ///< readings start again here, in the column's unit; 0: not stated
  double time_offset_s = 0.0;   ///< to add to the wheels' stamps
  // Noise of the motion, used as covariance of the integrated odometry.
  double sigma_distance_per_sqrt_m = 0.01;  ///< standard deviation of distance [m] after 1 m
  double sigma_heading_per_sqrt_m = 0.003;  ///< of heading [rad] after 1 m
  double sigma_lateral_per_sqrt_m = 0.003;  ///< of lateral slip [m] after 1 m
  double sigma_angle_rad = 0.001;           ///< of one wheel-angle reading
};

/// One reading: cumulative wheel angles [rad] of the rear axle, and the steering angle [rad] at the
/// road wheels if it is known. The reader of the table converts speeds and ticks to angles.
struct WheelReading {
  std::int64_t t_ns = 0;
  double left_angle_rad = 0.0;
  double right_angle_rad = 0.0;
  std::optional<double> steering_rad;
};

/// Planar motion between two times: T_a_b as (x, y, heading) and the covariance of that vector.
struct PlanarMotion {
  Eigen::Vector3d motion = Eigen::Vector3d::Zero();  ///< x [m], y [m], heading [rad] of b in a
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double distance_m = 0.0;  ///< along the path, >= 0
  bool reversing = false;   ///< net motion backwards
};

/// Returns the distance [m] that the middle of the rear axle drove and the change of heading [rad],
/// from the rotations of the wheels [rad]. This is where a wheel reading becomes a motion:
/// simulation, estimation and diagnosis all use it (templated on the scalar).
template <typename T>
Eigen::Matrix<T, 2, 1> wheel_increment(const T& left_turn_rad,
                                       const T& right_turn_rad,
                                       const T& radius_left_m,
                                       const T& radius_right_m,
                                       const T& track_width_m) {
  const T left = radius_left_m * left_turn_rad;
  const T right = radius_right_m * right_turn_rad;
  return {(left + right) / T(2), (right - left) / track_width_m};
}

/// Integrates readings, which ascend in time, and returns the motion between any two times.
class WheelOdometry {
 public:
  WheelOdometry(const WheelModel& model, std::vector<WheelReading> readings);

  /// Returns the motion from t_a to t_b (t_a <= t_b), with the wheels' time offset applied.
  /// Readings are interpolated linearly. Empty if the readings do not cover both times, or have a
  /// gap longer than `max_gap_ns` between them, or are distrusted at some time between.
  [[nodiscard]] std::optional<PlanarMotion> between(std::int64_t t_a_ns,
                                                    std::int64_t t_b_ns,
                                                    std::int64_t max_gap_ns = 500'000'000) const;
  /// Makes every motion unknown that overlaps the time from t_a to t_b (t_a < t_b).
  void distrust(std::int64_t t_a_ns, std::int64_t t_b_ns);
  [[nodiscard]] const WheelModel& model() const { return model_; }
  [[nodiscard]] bool empty() const { return readings_.empty(); }

 private:
  WheelModel model_;
  std::vector<WheelReading> readings_;
  std::vector<std::pair<std::int64_t, std::int64_t>> distrusted_;
};

}  // namespace roadbook
