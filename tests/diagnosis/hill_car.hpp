#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "diagnosis/streams/level_motion.hpp"
#include "tests/diagnosis/planar_car.hpp"

namespace roadbook::test {

// Hills: the height is a sine of the way on the map, up to 12 % steep. Everything a wheel and a
// gyro on them read follows in closed form from the plane drive of `PlanarCar`.
struct Hills {
  double share = 0.12;     // steepest slope
  double length_m = 60.0;  // of a hill and its valley
  double bank_rad = 0.0;   // the same everywhere
  [[nodiscard]] double slope(double way) const {
    return std::atan(share * std::cos(2.0 * std::numbers::pi * way / length_m));
  }
  [[nodiscard]] double height(double way) const {
    return share * length_m / (2.0 * std::numbers::pi) *
           std::sin(2.0 * std::numbers::pi * way / length_m);
  }
};

struct HillDrive {
  MotionStreams streams;
  std::vector<Attitude> attitudes;
  PitchRates pitch_rates;
  std::vector<double> heights;  // at the poses
};

/// `radius`: how much larger than stated the wheels are, relative.
inline HillDrive drive_over(const Hills& hills, std::uint64_t seed, double radius = 0.0) {
  HillDrive drive;
  drive.streams = PlanarCar(seed).record({});
  auto& wheels = drive.streams.wheels;
  const WheelModel& model = drive.streams.wheel_model;
  const std::vector<WheelSample> plane = wheels;
  std::vector<double> way{0.0};
  std::vector<double> stamps{plane.front().t_s};
  double left = plane.front().left_rad, right = plane.front().right_rad;
  for (std::size_t i = 1; i < plane.size(); ++i) {
    const double l = model.radius_left_m * (plane[i].left_rad - plane[i - 1].left_rad);
    const double r = model.radius_right_m * (plane[i].right_rad - plane[i - 1].right_rad);
    const double slope = hills.slope(way.back() + 0.25 * (l + r));
    const double rolled = 0.5 * (l + r) / std::cos(slope);
    // About the car's own axis, without pitching: the heading's rate times cos cos.
    const double change = hills.slope(way.back() + 0.5 * (l + r)) - hills.slope(way.back());
    const double turn = (r - l) / model.track_width_m * std::cos(slope) * std::cos(hills.bank_rad) +
                        change * std::sin(hills.bank_rad);
    left += (rolled - 0.5 * model.track_width_m * turn) / model.radius_left_m / (1.0 + radius);
    right += (rolled + 0.5 * model.track_width_m * turn) / model.radius_right_m / (1.0 + radius);
    wheels[i].left_rad = left;
    wheels[i].right_rad = right;
    way.push_back(way.back() + 0.5 * (l + r));
    stamps.push_back(plane[i].t_s);
  }
  const auto way_at = [&](double t) {
    const auto after = std::lower_bound(stamps.begin(), stamps.end(), t);
    if (after == stamps.begin()) return way.front();
    if (after == stamps.end()) return way.back();
    const auto i = static_cast<std::size_t>(after - stamps.begin());
    return way[i - 1] + (t - stamps[i - 1]) / (stamps[i] - stamps[i - 1]) * (way[i] - way[i - 1]);
  };
  for (GyroSample& g : drive.streams.gyro) {
    constexpr double kHalf = 0.01;
    const double slope = hills.slope(way_at(g.t_s));
    const double change =
        (hills.slope(way_at(g.t_s + kHalf)) - hills.slope(way_at(g.t_s - kHalf))) / (2.0 * kHalf);
    const double heading_rate = g.rate_rad_s;
    // Euler rates with pitch = -slope: w_y = -change cos(bank) + rate cos(slope) sin(bank).
    g.rate_rad_s = heading_rate * std::cos(slope) * std::cos(hills.bank_rad) +
                   change * std::sin(hills.bank_rad);
    drive.pitch_rates.push_back(
        {g.t_s, -change * std::cos(hills.bank_rad) +
                    heading_rate * std::cos(slope) * std::sin(hills.bank_rad)});
  }
  for (const PoseSample& pose : drive.streams.poses) {
    drive.attitudes.push_back({pose.t_s, hills.slope(way_at(pose.t_s)), hills.bank_rad});
    drive.heights.push_back(hills.height(way_at(pose.t_s)));
  }
  return drive;
}

}  // namespace roadbook::test
