#pragma once

#include <array>

#include "diagnosis/streams/trajectory.hpp"

namespace roadbook {

/// Integrals from the interval's begin of the two hat functions that rates are made of.
struct HatIntegrals {
  double first = 0.0;   ///< [s], of the one that is 1 at the begin
  double second = 0.0;  ///< of the one that is 1 at the end
};
[[nodiscard]] HatIntegrals hat_integrals(double step_s, double tau_s);

/// State `tau` after knot j and its derivatives by the rates at the interval's ends (speed A, yaw
/// A, speed B, yaw B) and by the heading at its begin.
struct IntervalJacobian {
  MotionState state;
  HatIntegrals hats;  ///< heading by yaw A and yaw B
  std::array<double, 4> x{}, y{};
  double x_by_heading = 0.0;
  double y_by_heading = 0.0;
};
[[nodiscard]] IntervalJacobian interval_jacobian(const Trajectory& trajectory,
                                                 std::size_t j,
                                                 double tau_s);

}  // namespace roadbook
