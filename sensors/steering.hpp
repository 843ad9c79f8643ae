#pragma once

#include <cmath>

#include "sensors/effects.hpp"

namespace roadbook {

// Model of a steering sensor: its reading in a moving car, with imperfections.

/// Sizes of the effects "steering0.X" (units: sensors/effects.cpp); all zero: the nominal sensor.
template <typename T>
struct SteeringImperfections {
  T offset{0.0};      ///< [rad]
  T ratio{0.0};       ///< relative
  T understeer{0.0};  ///< [s^2/m^2]
  T wheelbase{0.0};   ///< relative
  T latency{0.0};     ///< [s]; in addition to the latency of the rows (`wheels0.latency`)
};

[[nodiscard]] inline SteeringImperfections<double> steering_imperfections(
    const EffectSizes& sizes) {
  const auto size = [&](const char* effect) { return effect_size(sizes, "steering0", effect); };
  return {size("offset"), size("ratio"), size("understeer"), size("wheelbase"), size("latency")};
}

/// Returns the angle read [rad] at the road wheels: the angle of the single-track model without
/// side slip, with understeer, then with the sensor's ratio and offset. `speed` [m/s] must not be
/// zero and is negative in reverse; `yaw_rate` [rad/s]. The caller applies `latency`.
template <typename T>
T predict_steering(double wheelbase_m,
                   const SteeringImperfections<T>& off,
                   const T& speed,
                   const T& yaw_rate) {
  using std::atan;
  const T angle = atan(T(wheelbase_m) * (T(1.0) + off.wheelbase) * yaw_rate / speed);
  return angle * (T(1.0) + off.understeer * speed * speed) * (T(1.0) + off.ratio) + off.offset;
}

}  // namespace roadbook
