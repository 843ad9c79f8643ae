#include "drive/steering_check.hpp"

#include <cmath>
#include <numbers>
#include <sstream>

#include "drive/table_faults.hpp"

namespace roadbook {

void SteeringCheck::add(double left_turn_rad, double right_turn_rad, double steering_rad) {
  constexpr double kPiece_m = 0.5;
  const Eigen::Vector2d motion =
      wheel_increment(left_turn_rad, right_turn_rad, model_.radius_left_m, model_.radius_right_m,
                      model_.track_width_m);
  const double curvature = std::tan(steering_rad) / model_.wheelbase_m;
  if (!std::isfinite(curvature) || !motion.allFinite()) return;
  piece_m_ += std::abs(motion.x());
  turned_rad_ += std::copysign(1.0, motion.x()) * motion.y();
  steered_rad_ += curvature * std::abs(motion.x());
  if (piece_m_ < kPiece_m) return;
  const double by_wheels = turned_rad_ / piece_m_;
  const double by_steering = steered_rad_ / piece_m_;
  wheels2_ += by_wheels * by_wheels;
  steering2_ += by_steering * by_steering;
  both_ += by_wheels * by_steering;
  ++pieces_;
  piece_m_ = turned_rad_ = steered_rad_ = 0.0;
}

void SteeringCheck::report(const std::string& file,
                           const std::string& field,
                           ProblemList& problems) const {
  constexpr std::size_t kFewest = 20;
  constexpr double kStraight_m = 100.0;  // radius: on a straight drive the wheels' noise decides
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  const double n = static_cast<double>(pieces_);
  if (pieces_ < kFewest || wheels2_ / n < 1.0 / (kStraight_m * kStraight_m)) return;
  const double correlation = both_ / std::sqrt(wheels2_ * steering2_);
  if (!(std::abs(correlation) > 0.9)) return;
  const double ratio = both_ / steering2_;
  if (ratio >= 0.4 && ratio <= 2.5) return;
  const auto near = [&](double factor) { return std::abs(ratio / factor - 1.0) < 0.3; };
  std::string cause = "steering_ratio?";
  if (ratio < 0.0) cause = "the sign?";
  if (near(kDegrees)) cause = "radians taken for degrees?";
  if (near(1.0 / kDegrees)) cause = "degrees taken for radians?";
  std::ostringstream got;
  got.precision(3);
  got << "wheels that turn the vehicle " << ratio << " times as much" << in_brackets(cause);
  problems.warning(file, 0, field, got.str(), "angles with which the wheels agree");
}

}  // namespace roadbook
