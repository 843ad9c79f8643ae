#pragma once

#include <Eigen/Core>
#include <cmath>

#include "sensors/effects.hpp"
#include "sensors/wheels.hpp"

namespace roadbook {

// Model of the wheel readings in a moving car, with imperfections: the inverse of
// `wheel_increment`.

/// Sizes of the effects "wheels0.X" (units: sensors/effects.cpp); all zero: the nominal wheels.
template <typename T>
struct WheelImperfections {
  T left_radius{0.0};
  T right_radius{0.0};
  T radius{0.0};
  T radius_difference{0.0};  ///< right less left, relative to their mean
  T track_width{0.0};
  T locked_axle{0.0};        ///< share of the wheels' difference in bends that is missing
  T slip_acceleration{0.0};  ///< [s^2/m]
  T radius_speed{0.0};       ///< [s/m]
  T eccentricity{0.0};       ///< [rad]
  T wet_patch{0.0};
  T latency{0.0};  ///< [s]; a reading stamped t shows the wheels at t - latency
};

[[nodiscard]] inline WheelImperfections<double> wheel_imperfections(const EffectSizes& sizes) {
  const auto size = [&](const char* effect) { return effect_size(sizes, "wheels0", effect); };
  return {size("left_radius"),       size("right_radius"), size("radius"),
          size("radius_difference"), size("track_width"),  size("locked_axle"),
          size("slip_acceleration"), size("radius_speed"), size("eccentricity"),
          size("wet_patch"),         size("latency")};
}

/// True motion of the middle of the rear axle over one interval.
template <typename T>
struct TrueMotion {
  T distance_m{0.0};       ///< signed, along the arc
  T turn_rad{0.0};         ///< change of heading, positive to the left
  T speed{0.0};            ///< [m/s]
  T acceleration{0.0};     ///< [m/s^2]
  T left_phase_rad{0.0};   ///< true angle of the left wheel before the interval
  T right_phase_rad{0.0};  ///< of the right wheel
  bool wet = false;        ///< on wet ground
};

/// Returns the increments of the two wheel-angle readings [rad], left first. Slip and wet ground
/// turn the wheels more than they roll. Eccentricity adds size * sin(phase) to the angle read. The
/// wheels of a locked axle (1: a spool, no differential) turn equally in bends and slip instead.
/// The caller applies `latency`.
template <typename T>
Eigen::Matrix<T, 2, 1> predict_wheel_turns(const WheelModel& model,
                                           const WheelImperfections<T>& off,
                                           const TrueMotion<T>& motion) {
  using std::sin;
  const T grown = T(1.0) + off.radius_speed * motion.speed;
  const T half = T(0.5) * off.radius_difference;
  const T radius_left =
      T(model.radius_left_m) * (T(1.0) + off.radius + off.left_radius - half) * grown;
  const T radius_right =
      T(model.radius_right_m) * (T(1.0) + off.radius + off.right_radius + half) * grown;
  const T across = T(0.5 * model.track_width_m) * (T(1.0) + off.track_width) *
                   (T(1.0) - off.locked_axle) * motion.turn_rad;
  const T slip =
      T(1.0) + off.slip_acceleration * motion.acceleration + (motion.wet ? off.wet_patch : T(0.0));
  const auto read = [&](const T& roll, const T& radius, const T& phase) {
    const T turn = slip * roll / radius;
    return T(turn + off.eccentricity * (sin(phase + turn) - sin(phase)));
  };
  return {read(motion.distance_m - across, radius_left, motion.left_phase_rad),
          read(motion.distance_m + across, radius_right, motion.right_phase_rad)};
}

}  // namespace roadbook
