#pragma once

#include <cstddef>
#include <string>

#include "drive/problem_list.hpp"
#include "sensors/wheels.hpp"

namespace roadbook {

// Compares steering angles with the turns of the rear wheels: angles in another unit, of the
// steering wheel or of another sign stay within any bound on a gentle drive, but not within what
// the wheels do.

/// Curvature of the path by the wheels (turn over distance) against that by the steering
/// (tan(angle) / wheelbase), each over pieces of half a metre.
class SteeringCheck {
 public:
  explicit SteeringCheck(const WheelModel& model) : model_(model) {}
  /// The wheels turned by these angles [rad] while the road wheels stood at `steering_rad`.
  void add(double left_turn_rad, double right_turn_rad, double steering_rad);
  /// A warning where both curvatures go together (correlation above 0.9, 20 pieces or more) and the
  /// wheels' is more than 2.5 times the steering's, less than 0.4 times, or of the other sign.
  /// `field`: the column.
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
