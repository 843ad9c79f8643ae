#pragma once

#include <span>
#include <string_view>

#include "sensors/effects.hpp"
#include "sensors/imu_imperfections.hpp"
#include "sensors/pose_imperfections.hpp"
#include "sensors/steering.hpp"
#include "sensors/wheel_imperfections.hpp"

namespace roadbook {

/// Sizes of all effects that change motion streams. All zero: the nominal model.
struct MotionEffects {
  WheelImperfections<double> wheels;
  SteeringImperfections<double> steering;
  ImuImperfections<double> imu;
  PoseImperfections<double> pose;
  double bank = 0.0;  ///< share of each turn about the vertical that the car's own axis lacks
  double clock_drift =
      0.0;  ///< relative rate of the clock of wheels, steering and IMU to that of the poses
};

/// Bit mask of the streams whose predictions an effect changes.
enum StreamBits : unsigned { kWheels = 1, kSteeringBit = 2, kGyroBit = 4, kPoses = 8 };

/// One effect of the catalogue. To add one: add a line in motion_effects.cpp, a field in the struct
/// of its sensor, and its use in the prediction of that sensor.
struct MotionEffect {
  std::string_view name;
  double& (*size)(MotionEffects&);
  unsigned streams;
};

/// Bends that are banked. Only of references without roll: with it, streams are levelled.
inline constexpr std::string_view kBank = "ground.bank";

[[nodiscard]] std::span<const MotionEffect> motion_effects();
/// Index of `name` in `motion_effects()`; asserts that it exists.
[[nodiscard]] std::size_t effect_index(std::string_view name);
/// The effects in `sizes` that change motion streams; others are ignored.
[[nodiscard]] MotionEffects motion_effects_of(const EffectSizes& sizes);
/// Declaration of `name` in sensors/effects; asserts that it exists.
[[nodiscard]] const EffectInfo& declaration_of(std::string_view name);

}  // namespace roadbook
