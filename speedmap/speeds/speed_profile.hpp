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

/// The largest speed at which a location with presence `p` may be passed [metric-semantic maps,
/// section V-C]: `max_speed` at 0, `min_speed` at 1, linear between; p is clamped to [0, 1].
[[nodiscard]] double recommended_speed(double p, double min_speed, double max_speed);

/// The limits from which a profile is made, at equal steps along a path.
struct SpeedCeiling {
  double step_m = 0.25;
  bool closed = false;        ///< a ring: the last position is followed by the first
  std::vector<double> speed;  ///< upper bound [m/s], above 0
  /// Acceleration and braking that the grip there allows [m/s^2]; empty: any.
  std::vector<double> grip_acceleration;
};

/// Returns a speed for each position, nowhere above the ceiling, that the vehicle can follow:
/// braking begins early enough, and acceleration and jerk stay within their limits.
///
/// It works with b = v^2 over s, where acceleration is b' / 2 and jerk is v b'' / 2. A forward pass
/// limits the rise of b by acceleration and jerk. A backward pass does the same for braking. The
/// remaining upward kinks are cut off by the largest function below with a second derivative of at
/// least -2 jerk / v. All three steps only lower b, so the result is feasible; it is not always the
/// fastest. The speeds at both ends of an open path are bounded by the ceiling alone; there speed
/// begins to rise from acceleration 0. Linear time. Throws InvalidOption.
[[nodiscard]] std::vector<double> feasible_speeds(const SpeedCeiling& ceiling,
                                                  const MotionLimits& limits);

/// The largest acceleration, braking and jerk of a profile; for reports and tests.
struct ProfileDemand {
  double acceleration = 0.0;  ///< [m/s^2], largest
  double braking = 0.0;
  double jerk = 0.0;  ///< [m/s^3], largest amount, without the ends of an open way
};
[[nodiscard]] ProfileDemand demand_of(std::span<const double> speed, double step_m, bool closed);

}  // namespace roadbook
