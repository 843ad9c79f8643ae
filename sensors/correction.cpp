#include "sensors/correction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "sensors/camera_effects.hpp"
#include "sensors/steering.hpp"
#include "sensors/wheel_imperfections.hpp"

namespace roadbook {
namespace {

constexpr double kWindowS = 0.4;

constexpr std::array kRigEffects{"focal",    "aspect",     "centre",         "centre_x",
                                 "centre_y", "distortion", "distortion2",    "rotation",
                                 "pitch",    "roll",       "position",       "lateral",
                                 "height",   "latency",    "rolling_shutter"};
constexpr std::array kNoise{"outliers", "variance(speed)", "variance(turn)", "correlation"};
constexpr std::array kStreamEffects{"wheels0.left_radius",
                                    "wheels0.right_radius",
                                    "wheels0.radius",
                                    "wheels0.radius_difference",
                                    "wheels0.track_width",
                                    "wheels0.latency",
                                    "wheels0.slip_acceleration",
                                    "wheels0.radius_speed",
                                    "wheels0.eccentricity",
                                    "steering0.offset",
                                    "steering0.ratio",
                                    "steering0.understeer",
                                    "steering0.wheelbase",
                                    "clock.drift",
                                    "cam.latency",
                                    "imu0.gyro_bias",
                                    "imu0.gyro_scale",
                                    "imu0.latency",
                                    "imu0.tilt_roll",
                                    "imu0.tilt_pitch"};

double seconds_between(std::int64_t from_ns, std::int64_t to_ns) {
  return static_cast<double>(to_ns - from_ns) * 1e-9;
}

// Solves read = angle + size * sin(angle); converges for |size| < 1.
double without_eccentricity(double read, double size) {
  double angle = read;
  for (int i = 0; i < 20; ++i) angle = read - size * std::sin(angle);
  return angle;
}

// Distance that the nominal wheels' middle has rolled, at each reading.
std::vector<double> distances(const WheelModel& model, const std::vector<WheelReading>& readings) {
  std::vector<double> s;
  s.reserve(readings.size());
  for (const auto& r : readings)
    s.push_back(
        0.5 * (model.radius_left_m * r.left_angle_rad + model.radius_right_m * r.right_angle_rad));
  return s;
}

struct Motion {
  double speed = 0.0;
  double acceleration = 0.0;
};

// Slopes over the readings within half a window to both sides; at the ends over what there is.
std::vector<Motion> motions(const WheelModel& model, const std::vector<WheelReading>& readings) {
  const std::vector<double> s = distances(model, readings);
  const std::size_t n = readings.size();
  std::vector<Motion> motion(n);
  const auto slope = [&](std::size_t i, const auto& value) {
    std::size_t a = i;
    std::size_t b = i;
    while (a > 0 && seconds_between(readings[a - 1].t_ns, readings[i].t_ns) <= 0.5 * kWindowS) --a;
    while (b + 1 < n && seconds_between(readings[i].t_ns, readings[b + 1].t_ns) <= 0.5 * kWindowS)
      ++b;
    return b > a ? (value(b) - value(a)) / seconds_between(readings[a].t_ns, readings[b].t_ns)
                 : 0.0;
  };
  for (std::size_t i = 0; i < n; ++i)
    motion[i].speed = slope(i, [&](std::size_t k) { return s[k]; });
  for (std::size_t i = 0; i < n; ++i)
    motion[i].acceleration = slope(i, [&](std::size_t k) { return motion[k].speed; });
  return motion;
}

void correct_steering(const SteeringImperfections<double>& off, double speed, WheelReading& r) {
  if (!r.steering_rad) return;
  *r.steering_rad =
      (*r.steering_rad - off.offset) / (1.0 + off.ratio) / (1.0 + off.understeer * speed * speed);
}

}  // namespace

WheelModel corrected_wheels(const WheelModel& nominal, const EffectSizes& sizes) {
  const auto off = wheel_imperfections(sizes);
  WheelModel real = nominal;
  const double half = 0.5 * off.radius_difference;
  real.radius_left_m *= 1.0 + off.radius + off.left_radius - half;
  real.radius_right_m *= 1.0 + off.radius + off.right_radius + half;
  real.track_width_m *= 1.0 + off.track_width;
  real.wheelbase_m *= 1.0 + steering_imperfections(sizes).wheelbase;
  real.time_offset_s += effect_size(sizes, "cam", "latency") - off.latency;
  return real;
}

RangeModel corrected_range(const RangeModel& nominal, const EffectSizes& sizes) {
  RangeModel real = nominal;
  real.time_offset_s += effect_size(sizes, "cam", "latency");
  return real;
}

Rig corrected_rig(const Rig& nominal, const EffectSizes& sizes) {
  Rig real = nominal;
  for (auto& camera : real.cameras) camera = apply_camera_effects(camera, sizes);
  return real;
}

std::vector<WheelReading> corrected_readings(const WheelModel& nominal,
                                             const EffectSizes& sizes,
                                             std::int64_t origin_ns,
                                             std::vector<WheelReading> readings) {
  const auto off = wheel_imperfections(sizes);
  const auto steering = steering_imperfections(sizes);
  for (auto& r : readings) {
    r.t_ns = corrected_stamp(sizes, origin_ns, r.t_ns);
    r.left_angle_rad = without_eccentricity(r.left_angle_rad, off.eccentricity);
    r.right_angle_rad = without_eccentricity(r.right_angle_rad, off.eccentricity);
  }
  const auto motion = motions(nominal, readings);
  WheelReading before = readings.empty() ? WheelReading{} : readings.front();
  for (std::size_t i = 0; i < readings.size(); ++i) {
    WheelReading& r = readings[i];
    const WheelReading read = r;
    if (i > 0) {
      // predict_wheel_turns: turn = slip * roll / (radius * grown).
      const double speed = 0.5 * (motion[i - 1].speed + motion[i].speed);
      const double acceleration = 0.5 * (motion[i - 1].acceleration + motion[i].acceleration);
      const double factor =
          (1.0 + off.radius_speed * speed) / (1.0 + off.slip_acceleration * acceleration);
      r.left_angle_rad =
          readings[i - 1].left_angle_rad + factor * (read.left_angle_rad - before.left_angle_rad);
      r.right_angle_rad = readings[i - 1].right_angle_rad +
                          factor * (read.right_angle_rad - before.right_angle_rad);
    }
    correct_steering(steering, motion[i].speed, r);
    before = read;
  }
  return readings;
}

std::int64_t corrected_stamp(const EffectSizes& sizes, std::int64_t origin_ns, std::int64_t t_ns) {
  const double drift = effect_size(sizes, "clock", "drift");
  const double off_ns = static_cast<double>(t_ns - origin_ns) * drift / (1.0 + drift);
  return t_ns - static_cast<std::int64_t>(std::llround(off_ns));
}

std::vector<std::string> not_corrected(const EffectSizes& sizes) {
  std::vector<std::string> names;
  for (const auto& entry : sizes) {
    const std::string& name = entry.first;
    const double size = entry.second;
    const auto dot = name.find('.');
    const bool rig = name.starts_with("rig.") ||
                     (name.starts_with("cam") &&
                      std::any_of(kRigEffects.begin(), kRigEffects.end(),
                                  [&](const char* e) { return name.substr(dot + 1) == e; }));
    const bool stream = std::any_of(kStreamEffects.begin(), kStreamEffects.end(),
                                    [&](const char* e) { return name == e; });
    // Of noise there is nothing to correct.
    const bool noise = std::any_of(kNoise.begin(), kNoise.end(),
                                   [&](const char* e) { return name.substr(dot + 1) == e; });
    if (size != 0.0 && !rig && !stream && !noise) names.push_back(name);
  }
  return names;
}

}  // namespace roadbook
