#pragma once

#include "sensors/effects.hpp"

namespace roadbook {

// Model of a gyro: its reading in a turning car, with imperfections.

/// Sizes of the effects "imu0.X" (units: sensors/effects.cpp); all zero: the nominal sensor.
template <typename T>
struct ImuImperfections {
  T gyro_bias{0.0};   ///< [rad/s]
  T gyro_scale{0.0};  ///< relative
  T latency{0.0};     ///< [s]; a reading stamped t shows the motion at t - latency
};

[[nodiscard]] inline ImuImperfections<double> imu_imperfections(const EffectSizes& sizes) {
  const auto size = [&](const char* effect) { return effect_size(sizes, "imu0", effect); };
  return {size("gyro_bias"), size("gyro_scale"), size("latency")};
}

/// Returns the turn rate read [rad/s] about one axis. The caller applies `latency`.
template <typename T>
T predict_gyro(const ImuImperfections<T>& off, const T& turn_rate) {
  return turn_rate * (T(1.0) + off.gyro_scale) + off.gyro_bias;
}

}  // namespace roadbook
