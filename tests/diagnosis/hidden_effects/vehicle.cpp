#include "tests/diagnosis/hidden_effects/vehicle.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/random.hpp"

namespace roadbook::test {
namespace {

// A section of the route with the driver's targets until its end.
struct Stretch {
  double until_m;
  double curvature;
  double speed;
  bool stop;
};

std::vector<Stretch> random_route(Random& random, double length_m, bool straight) {
  std::vector<Stretch> route;
  double at = 0.0;
  while (at < length_m) {
    const double speed = random.uniform(1.5, 4.5);
    at += random.uniform(6.0, 25.0);
    route.push_back(
        {at, straight ? 0.0 : random.uniform(-0.01, 0.01), speed, random.uniform() < 0.12});
    if (straight) continue;
    const double radius = random.uniform(5.0, 14.0);
    const double turn = random.uniform(0.5, 2.2);
    const double side = random.uniform() < 0.5 ? -1.0 : 1.0;
    at += radius * turn;
    route.push_back({at, side / radius, random.uniform(1.5, 2.8), false});
  }
  return route;
}

// Speed and steering as second-order followers: no jump in acceleration or steering rate.
class Driver {
 public:
  void follow(double speed_aim, double steering_aim) {
    const double wanted = std::clamp(1.2 * (speed_aim - speed_), -2.0, 1.2);
    acceleration_ += kTick / 0.25 * (wanted - acceleration_);
    speed_ = std::max(0.0, speed_ + kTick * acceleration_);
    const double rate = std::clamp(3.0 * (steering_aim - steering_), -0.45, 0.45);
    rate_ += kTick / 0.12 * (rate - rate_);
    steering_ += kTick * rate_;
  }
  [[nodiscard]] double speed() const { return speed_; }
  [[nodiscard]] double acceleration() const { return acceleration_; }
  [[nodiscard]] double steering() const { return steering_; }

 private:
  double speed_ = 0.0, acceleration_ = 0.0, steering_ = 0.0, rate_ = 0.0;
};

// Returns the state one tick after `m`, for a new speed and steering angle.
Moment moved(const Moment& m, double speed, double steering, double wheelbase_m) {
  Moment next;
  next.speed = speed;
  next.acceleration = (next.speed - m.speed) / kTick;
  next.steering = steering;
  next.yaw_rate = next.speed * std::tan(next.steering) / wheelbase_m;
  const double v = 0.5 * (m.speed + next.speed);
  const double w = 0.5 * (m.yaw_rate + next.yaw_rate);
  next.heading = m.heading + kTick * w;
  next.turned = m.turned + kTick * w;
  next.distance = m.distance + kTick * v;
  const double middle = m.heading + 0.5 * kTick * w;
  next.x = m.x + kTick * v * std::cos(middle);
  next.y = m.y + kTick * v * std::sin(middle);
  return next;
}

}  // namespace

std::vector<Moment> drive_car_park(std::uint64_t seed,
                                   double length_m,
                                   double wheelbase_m,
                                   bool straight) {
  Random random(seed, "route");
  const auto route = random_route(random, length_m, straight);
  Driver driver;
  std::vector<Moment> drive(1);
  drive[0].heading = random.uniform(-3.0, 3.0);
  drive[0].x = random.uniform(-50.0, 50.0);
  drive[0].y = random.uniform(-50.0, 50.0);
  std::size_t stretch = 0;
  double hold = 1.0;  // [s] to stand still
  for (double ending = 0.0; ending < 1.5;) {
    const Moment& m = drive.back();
    const bool done = m.distance >= length_m;
    while (stretch + 1 < route.size() && m.distance >= route[stretch].until_m) {
      if (route[stretch].stop) hold = 1.5;
      ++stretch;
    }
    hold -= kTick;
    driver.follow(done || hold > 0.0 ? 0.0 : route[stretch].speed,
                  std::atan(wheelbase_m * route[stretch].curvature));
    if (done && m.speed < 0.01) ending += kTick;
    drive.push_back(moved(m, driver.speed(), driver.steering(), wheelbase_m));
  }
  return drive;
}

std::vector<Moment> drive_oval(std::uint64_t seed, double length_m, double wheelbase_m) {
  Random random(seed, "oval");
  const double round = 2.0 * std::numbers::pi / length_m;  // [rad/m] in the mean
  const double bulge = random.uniform(0.3, 0.7);
  const double first = random.uniform(0.0, 2.0 * std::numbers::pi);
  const double mean = random.uniform(3.6, 4.4);
  const double wave_m = random.uniform(25.0, 60.0);
  const auto speed = [&](double s) {
    return mean + 0.6 * std::sin(2.0 * std::numbers::pi * s / wave_m);
  };
  const auto steering = [&](double s) {
    return std::atan(wheelbase_m * round * (1.0 + bulge * std::cos(2.0 * round * s + first)));
  };
  std::vector<Moment> drive(1);
  drive[0].heading = random.uniform(-3.0, 3.0);
  drive[0].speed = speed(0.0);
  drive[0].steering = steering(0.0);
  drive[0].yaw_rate = drive[0].speed * std::tan(drive[0].steering) / wheelbase_m;
  while (drive.back().distance < length_m) {
    const double s = drive.back().distance;
    drive.push_back(moved(drive.back(), speed(s), steering(s), wheelbase_m));
  }
  return drive;
}

Moment moment_at(const std::vector<Moment>& drive, double t_s) {
  const double u = std::clamp(t_s / kTick, 0.0, static_cast<double>(drive.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(u), drive.size() - 2);
  const double w = u - static_cast<double>(i);
  const Moment& a = drive[i];
  const Moment& b = drive[i + 1];
  const auto mix = [w](double p, double q) { return p + w * (q - p); };
  return {mix(a.x, b.x),
          mix(a.y, b.y),
          mix(a.heading, b.heading),
          mix(a.speed, b.speed),
          mix(a.acceleration, b.acceleration),
          mix(a.yaw_rate, b.yaw_rate),
          mix(a.steering, b.steering),
          mix(a.distance, b.distance),
          mix(a.turned, b.turned)};
}

}  // namespace roadbook::test
