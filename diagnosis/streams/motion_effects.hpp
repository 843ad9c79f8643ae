#pragma once

#include <span>
#include <string_view>

#include "sensors/effects.hpp"
#include "sensors/imu_imperfections.hpp"
#include "sensors/pose_imperfections.hpp"
#include "sensors/steering.hpp"
#include "sensors/wheel_imperfections.hpp"

namespace roadbook {

/// Sizes of every effect that streams of motion can carry; all zero: the nominal simulation.
struct MotionEffects {
  WheelImperfections<double> wheels;
  SteeringImperfections<double> steering;
  ImuImperfections<double> imu;
  PoseImperfections<double> pose;
  double clock_drift = 0.0;  ///< clock of wheels, steering and IMU fast against the poses'
};

/// Streams whose predictions an effect changes.
enum StreamBits : unsigned { kWheels = 1, kSteeringBit = 2, kGyroBit = 4, kPoses = 8 };

/// One effect as diagnosis knows it. A further one is a line in motion_effects.cpp, a field in its
/// sensor's struct and its use in that sensor's prediction.
struct MotionEffect {
  std::string_view name;
  double& (*size)(MotionEffects&);
  unsigned streams;
};

[[nodiscard]] std::span<const MotionEffect> motion_effects();
/// Index of `name` among them; asserts that it is there.
[[nodiscard]] std::size_t effect_index(std::string_view name);
/// Sizes of those named that motion can carry.
[[nodiscard]] MotionEffects motion_effects_of(const EffectSizes& sizes);
/// Declaration of `name` in sensors/effects; asserts that there is one.
[[nodiscard]] const EffectInfo& declaration_of(std::string_view name);

}  // namespace roadbook
