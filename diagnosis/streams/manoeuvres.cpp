#include "diagnosis/streams/manoeuvres.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sensors/steering.hpp"

namespace roadbook {
namespace {

constexpr double kTick = 0.01;  // [s]

// Duration [s] of the beginning and the end of a turn, and of a change of speed.
constexpr double kEase = 1.5;

std::vector<ManoeuvreLeg> from_rest(double speed) {
  return {{1.0, 0.0, 0.0}, {speed / 1.2, speed, 0.0}};
}

void add_leg(std::vector<ManoeuvreLeg>& legs, double duration_s, double speed, double curvature) {
  legs.push_back({kEase, speed, curvature});
  legs.push_back({duration_s, speed, curvature});
}

void stop(std::vector<ManoeuvreLeg>& legs) {
  legs.push_back({kEase, legs.back().speed, 0.0});
  legs.push_back({legs.back().speed / 1.5, 0.0, 0.0});
}

// Consecutive arcs: radius [m] and angle [rad], both positive to the left.
std::vector<ManoeuvreLeg> arcs(double speed, const std::vector<std::pair<double, double>>& turns) {
  auto legs = from_rest(speed);
  for (const auto& [radius, angle] : turns)
    add_leg(legs, std::abs(radius) * angle / speed, speed, 1.0 / radius);
  stop(legs);
  return legs;
}

std::vector<ManoeuvreLeg> straight(const std::vector<double>& speeds, double length_m) {
  auto legs = from_rest(speeds.front());
  for (const double speed : speeds) add_leg(legs, length_m / speed, speed, 0.0);
  stop(legs);
  return legs;
}

std::vector<ManoeuvreLeg> brakings(int times) {
  std::vector<ManoeuvreLeg> legs{{1.0, 0.0, 0.0}};
  for (int i = 0; i < times; ++i) {
    legs.push_back({3.0, 5.0, 0.0});
    legs.push_back({2.0, 0.3, 0.0});
  }
  legs.push_back({1.0, 0.0, 0.0});
  return legs;
}

std::vector<ManoeuvreLeg> followed_by(std::vector<ManoeuvreLeg> a,
                                      const std::vector<ManoeuvreLeg>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

std::vector<ManoeuvreLeg> laps(int count) {
  auto legs = from_rest(3.0);
  for (int lap = 0; lap < count; ++lap)
    for (int side = 0; side < 2; ++side) {
      add_leg(legs, 10.0, 4.0, 0.0);
      add_leg(legs, 6.0 * std::numbers::pi / 2.5, 2.5, lap % 2 == 0 ? 1.0 / 6.0 : -1.0 / 6.0);
    }
  stop(legs);
  return legs;
}

std::vector<Manoeuvre> make_manoeuvres() {
  constexpr double kPi = std::numbers::pi;
  std::vector<Manoeuvre> all{
      {"a straight line of 40 m at 3 m/s", straight({3.0}, 40.0)},
      {"a turn of 90 degrees to the left at 2 m/s", arcs(2.0, {{6.0, 0.5 * kPi}})},
      {"a turn of 90 degrees to the right at 2 m/s", arcs(2.0, {{-6.0, 0.5 * kPi}})},
      {"speeding up to 5 m/s and braking hard, three times", brakings(3)},
      {"a straight line of 40 m at 1.5 and at 5 m/s", straight({1.5, 5.0}, 40.0)},
      {"a slalom at 3 m/s",
       arcs(3.0, {{9.0, 0.8}, {-9.0, 1.6}, {9.0, 1.6}, {-9.0, 1.6}, {9.0, 0.8}})},
      {"a full circle to the left and one to the right at 2 m/s",
       arcs(2.0, {{6.0, 2.0 * kPi}, {-6.0, 2.0 * kPi}})},
      {"the same circle of 10 m radius at 1.5 and at 5 m/s",
       followed_by(arcs(1.5, {{10.0, 2.0 * kPi}}), arcs(5.0, {{10.0, 2.0 * kPi}}))},
      {"five minutes of laps, left and right", laps(8)},
  };
  std::stable_sort(all.begin(), all.end(), [](const Manoeuvre& a, const Manoeuvre& b) {
    return a.duration_s() < b.duration_s();
  });
  return all;
}

template <typename Sample>
std::size_t stride_of(const std::vector<Sample>& samples) {
  if (samples.size() < 2) return 0;
  const double step =
      (samples.back().t_s - samples.front().t_s) / static_cast<double>(samples.size() - 1);
  return std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(step / kTick)));
}

}  // namespace

double Manoeuvre::duration_s() const {
  double sum = 0.0;
  for (const ManoeuvreLeg& leg : legs) sum += leg.duration_s;
  return sum;
}

const std::vector<Manoeuvre>& manoeuvres() {
  static const std::vector<Manoeuvre> all = make_manoeuvres();
  return all;
}

MotionStreams streams_of(const Manoeuvre& manoeuvre, const MotionStreams& like) {
  MotionStreams s;
  s.wheel_model = like.wheel_model;
  s.wheels_read = like.wheels_read;
  s.poses_have_heading = like.poses_have_heading;
  const std::size_t poses = stride_of(like.poses);
  const std::size_t wheels = stride_of(like.wheels);
  const std::size_t steering = stride_of(like.steering);
  const std::size_t gyro = stride_of(like.gyro);
  PoseSample pose;
  WheelSample wheel;
  double speed = 0.0;
  double curvature = 0.0;
  std::size_t tick = 0;
  const auto due = [&](std::size_t stride) { return stride > 0 && tick % stride == 0; };
  for (const ManoeuvreLeg& leg : manoeuvre.legs) {
    const auto ticks = std::max(1L, std::lround(leg.duration_s / kTick));
    const double more_speed = (leg.speed - speed) / static_cast<double>(ticks);
    const double more_curvature = (leg.curvature - curvature) / static_cast<double>(ticks);
    for (long i = 0; i < ticks; ++i, ++tick) {
      const double yaw_rate = speed * curvature;
      pose.t_s = wheel.t_s = static_cast<double>(tick) * kTick;
      if (due(poses)) s.poses.push_back(pose);
      if (due(wheels)) s.wheels.push_back(wheel);
      if (due(gyro)) s.gyro.push_back({pose.t_s, yaw_rate});
      if (due(steering))
        s.steering.push_back({pose.t_s, std::atan(like.wheel_model.wheelbase_m * curvature)});
      const double turn = yaw_rate * kTick;
      const double middle = pose.heading + 0.5 * turn;
      const double across = 0.5 * like.wheel_model.track_width_m * turn;
      pose.x += speed * kTick * std::cos(middle);
      pose.y += speed * kTick * std::sin(middle);
      pose.heading += turn;
      wheel.left_rad += (speed * kTick - across) / like.wheel_model.radius_left_m;
      wheel.right_rad += (speed * kTick + across) / like.wheel_model.radius_right_m;
      speed += more_speed;
      curvature += more_curvature;
    }
  }
  return s;
}

}  // namespace roadbook
