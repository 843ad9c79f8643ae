#pragma once

#include <cstddef>
#include <string>

#include "drive/problem_list.hpp"
#include "sensors/wheels.hpp"

namespace roadbook {

// Compares steering angles with the motion of the rear wheels. Angles in another unit, of the
// steering wheel or with another sign stay within plausible bounds on a gentle drive, but
// contradict the wheels.

/// Compares two curvatures over pieces of half a metre: by the wheels (turn over distance) and by
/// the steering (tan(angle) / wheelbase).
class SteeringCheck {
 public:
  explicit SteeringCheck(const WheelModel& model) : model_(model) {}
  /// The wheels turned by these angles [rad] while the road wheels stood at `steering_rad`.
  void add(double left_turn_rad, double right_turn_rad, double steering_rad);
  /// Adds a warning if the curvatures are correlated (above 0.9, at least 20 pieces) and the
  /// curvature of the wheels is more than 2.5 times that of the steering, less than 0.4 times, or
  /// of opposite sign. `field`: name of the column.
  void report(const std::string& file, const std::string& field, ProblemList& problems) const;

 private:
  WheelModel model_;
  double piece_m_ = 0.0;
  double turned_rad_ = 0.0;   ///< by the wheels, in this piece
  double steered_rad_ = 0.0;  ///< by the steering
  std::size_t pieces_ = 0;
  double wheels2_ = 0.0;  ///< sums of squares and products of curvatures
  double steering2_ = 0.0;
  double both_ = 0.0;
};

}  // namespace roadbook
