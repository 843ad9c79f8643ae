#include "diagnosis/views/view_timing.hpp"

#include <cmath>

#include "base/index.hpp"
#include "sensors/wheel_imperfections.hpp"

namespace roadbook {
namespace {

// Derivative of the read speed and yaw rate by the true ones, without eccentricity.
Eigen::Matrix2d reading_gain(const WheelModel& wheels,
                             const WheelImperfections<double>& off,
                             const ViewMoment& moment) {
  const auto read = [&](double distance_m, double turn_rad) -> Eigen::Vector2d {
    TrueMotion<double> m;
    m.distance_m = distance_m;
    m.turn_rad = turn_rad;
    m.speed = moment.speed;
    m.acceleration = moment.acceleration;
    const auto turns = predict_wheel_turns<double>(wheels, off, m);
    return wheel_increment<double>(turns.x(), turns.y(), wheels.radius_left_m,
                                   wheels.radius_right_m, wheels.track_width_m);
  };
  Eigen::Matrix2d gain;
  gain << read(1.0, 0.0), read(0.0, 1.0);
  return gain;
}

}  // namespace

ViewTiming::ViewTiming(const ViewData& data, const EffectSizes& effects)
    : wheels_late_(effect_size(effects, "wheels0", "latency")), moments_(data.moments) {
  for (const MountedCamera& camera : data.bundle.cameras) {
    shutter_.push_back(camera.rolling_shutter_s +
                       effect_size(effects, camera.name, "rolling_shutter"));
    late_.push_back(effect_size(effects, camera.name, "latency") - camera.exposed_after_s);
  }
  constexpr double kLeastGain = 0.1;  // a locked axle hardly reads turns
  WheelImperfections<double> off = wheel_imperfections(effects);
  off.eccentricity = 0.0;  // smoothing has removed it from the rates
  for (ViewMoment& m : moments_) {
    if (!m.read_by_wheels) continue;
    const Eigen::Matrix2d gain = reading_gain(data.wheels, off, m);
    if (!(std::abs(gain.determinant()) > kLeastGain)) continue;
    Eigen::Matrix2d rates;
    rates << m.speed, m.acceleration, m.yaw_rate, m.yaw_acceleration;
    rates = gain.inverse() * rates.eval();
    m.speed = rates(0, 0);
    m.acceleration = rates(0, 1);
    m.yaw_rate = rates(1, 0);
    m.yaw_acceleration = rates(1, 1);
  }
}

double ViewTiming::row_share(const Camera& camera, double row) {
  return (row + 0.5) / camera.height - 0.5;
}

double ViewTiming::after_stamp(const Camera& camera, int which, double row) const {
  return shutter_[at(which)] * row_share(camera, row) - late_[at(which)];
}

Vector6d ViewTiming::twist(int pose, double dt_s) const {
  const ViewMoment& m = moments_[at(pose)];
  const double ahead_s = wheels_late_ + 0.5 * dt_s;
  Vector6d xi = Vector6d::Zero();
  xi[0] = m.speed + ahead_s * m.acceleration;
  xi[5] = m.yaw_rate + ahead_s * m.yaw_acceleration;
  return xi;
}

}  // namespace roadbook
