#pragma once

#include <Eigen/Geometry>

#include "sensors/effects.hpp"

namespace roadbook {

// Model of an IMU: the reading of its gyro in a turning car, and the direction of its axes.

/// Sizes of the effects "imu0.X" (units: sensors/effects.cpp); all zero: the nominal sensor.
template <typename T>
struct ImuImperfections {
  T gyro_bias{0.0};   ///< [rad/s]
  T gyro_scale{0.0};  ///< relative
  T latency{0.0};     ///< [s]; a reading stamped t shows the motion at t - latency
  T tilt_roll{0.0};   ///< [rad], positive with the right side down
  T tilt_pitch{0.0};  ///< [rad], positive with the front up
};

[[nodiscard]] inline ImuImperfections<double> imu_imperfections(const EffectSizes& sizes) {
  const auto size = [&](const char* effect) { return effect_size(sizes, "imu0", effect); };
  return {size("gyro_bias"), size("gyro_scale"), size("latency"), size("tilt_roll"),
          size("tilt_pitch")};
}

/// Returns the turn rate read [rad/s] about one axis. The caller applies `latency` and tilt.
template <typename T>
T predict_gyro(const ImuImperfections<T>& off, const T& turn_rate) {
  return turn_rate * (T(1.0) + off.gyro_scale) + off.gyro_bias;
}

/// Rotation from the axes of a tilted IMU to the stated ones: first the roll about the x axis, then
/// the pitch about the y axis. A tilted IMU reads the transpose times what the stated one reads.
/// Its z axis reads cos(roll) cos(pitch) of a turn on level ground, its x axis sin(pitch) of the
/// turn, its y axis sin(roll) cos(pitch). Gravity appears in its accelerations in the same way.
[[nodiscard]] inline Eigen::Matrix3d tilt_rotation(double roll_rad, double pitch_rad) {
  return (Eigen::AngleAxisd(-pitch_rad, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}
[[nodiscard]] inline Eigen::Matrix3d tilt_rotation(const EffectSizes& sizes) {
  const ImuImperfections<double> off = imu_imperfections(sizes);
  return tilt_rotation(off.tilt_roll, off.tilt_pitch);
}

}  // namespace roadbook
