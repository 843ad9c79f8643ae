#pragma once

#include <span>
#include <vector>

namespace roadbook {

/// Limits of the vehicle's motion.
struct MotionLimits {
  double acceleration = 1.0;  ///< [m/s^2] along the way
  double braking = 1.5;       ///< [m/s^2]
  double lateral = 1.5;       ///< [m/s^2]
  double jerk = 1.5;          ///< [m/s^3] along the way

  /// Throws InvalidOption.
  void check() const;
};

/// The largest speed at which a place with presence `p` may be passed [metric-semantic maps,
/// section V-C]: `max_speed` at 0, `min_speed` at 1, linear between; p is held to [0, 1].
[[nodiscard]] double recommended_speed(double p, double min_speed, double max_speed);

/// What a profile is made from, at equal steps along a way.
struct SpeedCeiling {
  double step_m = 0.25;
  bool closed = false;        ///< a ring: the last place is followed by the first
  std::vector<double> speed;  ///< not to be exceeded [m/s], above 0
  /// Acceleration and braking that the place itself allows [m/s^2] (grip); empty: any.
  std::vector<double> grip_acceleration;
};

/// A speed at each place, nowhere above the ceiling, that the vehicle can follow: braking begins
/// early enough, acceleration and jerk stay within their limits.
///
/// In b = v^2 over s, where acceleration is b' / 2 and jerk v b'' / 2: a pass forwards lets b rise
/// no faster than acceleration and jerk allow, one backwards likewise for braking, and the larger
/// kinks upwards that remain are cut off by the largest function below whose second derivative is
/// at least -2 jerk / v. All three only lower b, so the result is feasible; it is not always the
/// fastest. Both ends of an open way are left to the ceiling; speed there begins to rise from
/// acceleration 0. Linear time. Throws InvalidOption.
[[nodiscard]] std::vector<double> feasible_speeds(const SpeedCeiling& ceiling,
                                                  const MotionLimits& limits);

/// The hardest that a profile asks for; for reports and tests.
struct ProfileDemand {
  double acceleration = 0.0;  ///< [m/s^2], largest
  double braking = 0.0;
  double jerk = 0.0;  ///< [m/s^3], largest amount, without the ends of an open way
};
[[nodiscard]] ProfileDemand demand_of(std::span<const double> speed, double step_m, bool closed);

}  // namespace roadbook
