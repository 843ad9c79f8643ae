#pragma once

#include <cstdint>
#include <vector>

namespace roadbook::test {

/// State of the vehicle at one millisecond step.
struct Moment {
  double x = 0.0, y = 0.0, heading = 0.0;
  double speed = 0.0, acceleration = 0.0;
  double yaw_rate = 0.0, steering = 0.0;
  double distance = 0.0, turned = 0.0;
};

inline constexpr double kTick = 1e-3;  // [s]

/// A random route through a car park: straights, bends, stops; smooth in speed and steering.
[[nodiscard]] std::vector<Moment> drive_car_park(std::uint64_t seed,
                                                 double length_m,
                                                 double wheelbase_m,
                                                 bool straight);

/// One lap of an oval of the given length at 3 to 5 m/s, without abrupt changes.
[[nodiscard]] std::vector<Moment> drive_oval(std::uint64_t seed,
                                             double length_m,
                                             double wheelbase_m);

/// Linear interpolation between moments; standstill before and after.
[[nodiscard]] Moment moment_at(const std::vector<Moment>& drive, double t_s);

}  // namespace roadbook::test
