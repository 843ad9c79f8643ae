#include "sim/world/vehicle.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/se3.hpp"

namespace roadbook {
namespace {

constexpr double kMotionStep = 0.005;  // [s]
constexpr double kGrid = 0.1;          // [m], of the speed plan

/// The speed the driver may have at every place of the whole drive.
class SpeedPlan {
 public:
  SpeedPlan(const DrivingLine& line, double total_m, const VehicleSpec& v) {
    const auto n = static_cast<std::size_t>(std::ceil(total_m / kGrid)) + 1;
    limit_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      const double bend = std::abs(line.curvature(static_cast<double>(i) * kGrid));
      limit_[i] =
          std::min(v.max_speed, std::sqrt(v.max_lateral_acceleration / std::max(bend, 1e-6)));
    }
  }
  void stop_at(double s) {
    const auto i = static_cast<std::size_t>(s / kGrid);
    if (i < limit_.size()) limit_[i] = 0.0;
  }
  /// Backwards pass: the speed stays within the braking limit (a bit gentler than the limit).
  void finish(double braking) {
    limit_.back() = 0.0;
    for (std::size_t i = limit_.size() - 1; i-- > 0;)
      limit_[i] = std::min(limit_[i],
                           std::sqrt(limit_[i + 1] * limit_[i + 1] + 2.0 * 0.7 * braking * kGrid));
  }
  [[nodiscard]] double at(double s) const {
    const double u = std::clamp(s / kGrid, 0.0, static_cast<double>(limit_.size() - 1));
    const auto i = std::min(static_cast<std::size_t>(u), limit_.size() - 2);
    const double f = u - static_cast<double>(i);
    return (1.0 - f) * limit_[i] + f * limit_[i + 1];
  }

 private:
  std::vector<double> limit_;
};

struct Stop {
  double at_m;
  double seconds;
};

std::vector<Stop> all_stops(const DrivingLine& line, int laps, const std::vector<StopSpec>& stops) {
  std::vector<Stop> all;
  for (int lap = 0; lap < laps; ++lap)
    for (const StopSpec& stop : stops)
      if (stop.at_m < line.length_m())
        all.push_back({lap * line.length_m() + stop.at_m, stop.seconds});
  std::sort(all.begin(), all.end(), [](const Stop& a, const Stop& b) { return a.at_m < b.at_m; });
  return all;
}

/// How far the driver strays to the left at s: a sum of three slow waves.
struct Wander {
  double amplitude_m;
  double phase[3];
  Wander(double amplitude, Random& random) : amplitude_m(amplitude) {
    for (double& p : phase) p = random.uniform(0.0, 6.283185307179586);
  }
  [[nodiscard]] double at(double s) const {
    return amplitude_m * (0.6 * std::sin(s / 11.0 + phase[0]) + 0.3 * std::sin(s / 5.3 + phase[1]) +
                          0.4 * std::sin(s / 31.0 + phase[2]));
  }
};

double steer_towards(
    const VehicleState& now, const DrivingLine& line, double s, double aside, double wheelbase_m) {
  const double ahead = std::clamp(0.9 * now.speed + 0.8, 1.6, 12.0);
  const double heading = line.heading(s + ahead);
  const Eigen::Vector2d target =
      line.at(s + ahead) + aside * Eigen::Vector2d(-std::sin(heading), std::cos(heading));
  const Eigen::Vector2d to = target - Eigen::Vector2d(now.x, now.y);
  const double bearing = wrap_angle(std::atan2(to.y(), to.x()) - now.heading);
  return std::atan(2.0 * wheelbase_m * std::sin(bearing) / to.norm());
}

/// Moves the car along its own x axis on the ground.
void advance(VehicleState& s,
             const Ground& ground,
             const VehicleSpec& vehicle,
             double moved,
             double turned,
             double creep) {
  const Eigen::Isometry3d T = ground.stand(s.x, s.y, s.heading + 0.5 * turned, vehicle.wheelbase_m,
                                           vehicle.track_width_m, s.height_m);
  const Eigen::Vector3d d = T.linear() * Eigen::Vector3d(moved, creep, 0.0);
  s.x += d.x();
  s.y += d.y();
  s.height_m = ground.height(s.x, s.y, s.height_m);
  s.heading += turned;
  s.distance_m += moved;
  s.turned += turned;
}

void brake_to_rest(const VehicleSpec& vehicle, VehicleState& s) {
  const double speed = std::max(0.0, s.speed - kMotionStep * vehicle.max_braking);
  s.acceleration = (speed - s.speed) / kMotionStep;
  s.speed = speed;
  s.yaw_rate = speed * std::tan(s.steering) / vehicle.wheelbase_m;
}

}  // namespace

VehicleMotion::VehicleMotion(std::vector<VehicleState> states,
                             const Ground& ground,
                             const VehicleSpec& vehicle)
    : states_(std::move(states)), ground_(ground), vehicle_(vehicle), step_s_(kMotionStep) {
  ROADBOOK_ASSERT(states_.size() >= 2);
}

VehicleState VehicleMotion::at(double t_s) const {
  const double u = std::clamp(t_s / step_s_, 0.0, static_cast<double>(states_.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(u), states_.size() - 2);
  const double f = u - static_cast<double>(i);
  const VehicleState& a = states_[i];
  const VehicleState& b = states_[i + 1];
  const auto mix = [f](double p, double q) { return p + f * (q - p); };
  VehicleState s;
  s.t_s = mix(a.t_s, b.t_s);
  s.x = mix(a.x, b.x);
  s.y = mix(a.y, b.y);
  s.heading = mix(a.heading, b.heading);
  s.speed = mix(a.speed, b.speed);
  s.acceleration = mix(a.acceleration, b.acceleration);
  s.yaw_rate = mix(a.yaw_rate, b.yaw_rate);
  s.steering = mix(a.steering, b.steering);
  s.distance_m = mix(a.distance_m, b.distance_m);
  s.turned = mix(a.turned, b.turned);
  s.height_m = mix(a.height_m, b.height_m);
  return s;
}

Eigen::Isometry3d VehicleMotion::T_world_vehicle(double t_s) const {
  const VehicleState s = at(t_s);
  return ground_.stand(s.x, s.y, s.heading, vehicle_.wheelbase_m, vehicle_.track_width_m,
                       s.height_m) *
         Eigen::AngleAxisd(vehicle_.nose_down_rad, Eigen::Vector3d::UnitY());
}

VehicleMotion drive_line(const DrivingLine& line,
                         int laps,
                         const std::vector<StopSpec>& stops,
                         const VehicleSpec& vehicle,
                         const Ground& ground,
                         const DriverOptions& options,
                         Random& random) {
  const double total = laps * line.length_m() + (line.closed() ? 4.0 : 0.0);
  SpeedPlan plan(line, total, vehicle);
  const std::vector<Stop> waits = all_stops(line, laps, stops);
  for (const Stop& stop : waits) plan.stop_at(stop.at_m);
  plan.finish(vehicle.max_braking);
  const Wander wander(options.wander ? vehicle.wander_m : 0.0, random);

  VehicleState now;
  now.x = line.at(0.0).x();
  now.y = line.at(0.0).y();
  now.heading = line.heading(0.0);
  std::vector<VehicleState> states{now};
  double s = 0.0;  // progress along the line
  double standing_s = 0.4;
  std::size_t next_stop = 0;
  const double longest_s =
      60.0 + 40.0 * total / vehicle.max_speed + 600.0 * static_cast<double>(waits.size());
  while (now.t_s < longest_s) {
    VehicleState next = now;
    next.t_s = kMotionStep * static_cast<double>(states.size());
    if (standing_s > 0.0) {
      standing_s -= kMotionStep;
      brake_to_rest(vehicle, next);
    } else {
      const double wish = std::max(plan.at(s + 0.3 * now.speed), 0.12);
      const double wanted = (wish - now.speed) / 0.25;
      const double limited = std::clamp(wanted, -vehicle.max_braking, vehicle.max_acceleration);
      // A passenger's comfort: the acceleration itself changes no faster than 4 m/s^3.
      next.acceleration = std::clamp(limited, now.acceleration - 4.0 * kMotionStep,
                                     now.acceleration + 4.0 * kMotionStep);
      next.speed = std::max(0.0, now.speed + kMotionStep * next.acceleration);
      const double steer =
          std::clamp(steer_towards(now, line, s, wander.at(s), vehicle.wheelbase_m),
                     -vehicle.max_steering, vehicle.max_steering);
      const double turn = vehicle.max_steering_rate * kMotionStep;
      next.steering = std::clamp(steer, now.steering - turn, now.steering + turn);
      next.yaw_rate = next.speed * std::tan(next.steering) / vehicle.wheelbase_m;
    }
    const double moved = kMotionStep * 0.5 * (now.speed + next.speed);
    const double turned = kMotionStep * 0.5 * (now.yaw_rate + next.yaw_rate);
    const double creep = options.lateral_slip_per_sqrt_m * std::sqrt(moved) * random.normal();
    advance(next, ground, vehicle, moved, turned, creep);
    states.push_back(next);
    now = next;
    s = line.nearest({now.x, now.y}, s + moved, 0.3);
    if (next_stop < waits.size() && s >= waits[next_stop].at_m - 0.15) {
      standing_s = std::max(kMotionStep, waits[next_stop].seconds);
      ++next_stop;
    }
    if (s >= total - 0.1) break;
  }
  // The end: at rest, and a moment longer, so that sensors that lag still see it.
  for (double rest = 0.0; rest < 0.3;) {
    now.t_s = kMotionStep * static_cast<double>(states.size());
    brake_to_rest(vehicle, now);
    advance(now, ground, vehicle, kMotionStep * now.speed, kMotionStep * now.yaw_rate, 0.0);
    states.push_back(now);
    if (now.speed == 0.0) rest += kMotionStep;
  }
  return {std::move(states), ground, vehicle};
}

}  // namespace roadbook
