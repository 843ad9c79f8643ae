#include "diagnosis/streams/wheel_rows.hpp"

#include <cmath>

#include "sensors/wheels.hpp"

namespace roadbook {

Eigen::Vector2d rolled(const WheelModel& model, WheelsRead read, const Eigen::Vector2d& angles) {
  if (read == WheelsRead::kBoth)
    return wheel_increment<double>(angles.x(), angles.y(), model.radius_left_m,
                                   model.radius_right_m, model.track_width_m);
  if (read == WheelsRead::kRight) return {model.radius_right_m * angles.y(), 0.0};
  return {model.radius_left_m * angles.x(), 0.0};
}

Eigen::Vector2d predict_wheel_row(const WheelModel& model,
                                  WheelsRead read,
                                  const MotionEffects& effects,
                                  const TrueMotion<double>& motion) {
  TrueMotion<double> of_wheel = motion;
  of_wheel.turn_rad *= 1.0 - effects.bank;
  if (read == WheelsRead::kFront) {
    const double aside = model.wheelbase_m * (1.0 + effects.steering.wheelbase) * of_wheel.turn_rad;
    of_wheel.distance_m = std::copysign(std::hypot(motion.distance_m, aside), motion.distance_m);
  }
  if (read == WheelsRead::kMiddle || read == WheelsRead::kFront) of_wheel.turn_rad = 0.0;
  return rolled(model, read, predict_wheel_turns(model, effects.wheels, of_wheel));
}

Eigen::Matrix2d wheel_row_gain(const WheelModel& model,
                               WheelsRead read,
                               const MotionEffects& effects,
                               const TrueMotion<double>& motion) {
  MotionEffects smooth = effects;
  smooth.wheels.eccentricity = 0.0;
  const auto row = [&](double distance, double turn) {
    TrueMotion<double> m;
    m.distance_m = distance;
    m.turn_rad = turn;
    return predict_wheel_row(model, read, smooth, m);
  };
  Eigen::Matrix2d gain;
  gain << row(1.0, 0.0), row(0.0, 1.0);
  if (read != WheelsRead::kFront) return gain;
  const double L = model.wheelbase_m * (1.0 + effects.steering.wheelbase) * (1.0 - effects.bank);
  const double forward = motion.distance_m;
  const double aside = L * motion.turn_rad;
  const double way = std::hypot(forward, aside);
  const double share = way > 0.0 ? std::abs(forward) / way : 1.0;
  const double by_turn = way > 0.0 ? std::copysign(L * aside / way, forward * aside) : 0.0;
  const Eigen::Vector2d along = gain.col(0);
  gain << along * share, along * by_turn;
  return gain;
}

bool shows_effect(WheelsRead read, std::string_view effect) {
  if (read == WheelsRead::kBoth || !effect.starts_with("wheels0.")) return true;
  const bool left = read == WheelsRead::kLeft;
  const bool right = read == WheelsRead::kRight;
  if (effect == "wheels0.radius_difference" || effect == "wheels0.locked_axle") return false;
  if (effect == "wheels0.left_radius") return left;
  if (effect == "wheels0.right_radius") return right;
  if (effect == "wheels0.radius") return !left && !right;
  if (effect == "wheels0.track_width") return left || right;
  if (effect == "wheels0.eccentricity") return read != WheelsRead::kMiddle;
  return true;
}

}  // namespace roadbook
