#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "diagnosis/streams/streams.hpp"

namespace roadbook::test {

/// Delays [s] of the clocks of a `PlanarCar`, and the noise of its sensors.
struct PlanarCarOptions {
  double poses_late_s = 0.0;
  double wheels_late_s = 0.0;
  double gyro_late_s = 0.0;
  double position_m = 0.03;
  double heading_rad = 2e-3;
  double way_per_sqrt_m = 3e-3;  ///< of each wheel
  double gyro_rad_s = 3e-3;
  bool with_gyro = true;
};

/// A car on a plane whose speed and turn rate are sums of sines: distances and headings are known
/// in closed form. Independent of the simulator. Poses at 10 Hz, wheels and gyro at 100 Hz, 75 s at
/// 4 m/s.
class PlanarCar {
 public:
  explicit PlanarCar(std::uint64_t seed) : draw_(seed) {
    for (Wave& w : speed_) w = wave(0.3, 0.8, 0.02, 0.06);
    for (Wave& w : turn_) w = wave(0.1, 0.25, 0.05, 0.15);
    for (int i = 0; i <= 4 * kSteps; ++i) {
      // The midpoint rule over a quarter step: 2.5 ms at 4 m/s, errors of micrometres.
      const double t = (i + 0.5) * 0.25 * kStep;
      x_.push_back(i == 0 ? 0.0 : x_.back() + dx_);
      y_.push_back(i == 0 ? 0.0 : y_.back() + dy_);
      dx_ = 0.25 * kStep * speed(t) * std::cos(heading(t));
      dy_ = 0.25 * kStep * speed(t) * std::sin(heading(t));
    }
  }

  MotionStreams record(const PlanarCarOptions& options) {
    MotionStreams streams;
    streams.wheel_model.radius_left_m = streams.wheel_model.radius_right_m = kRadius;
    streams.wheel_model.track_width_m = kTrack;
    std::array<double, 2> drift{};
    double before = way(0.0);
    for (int i = 50; i + 50 < kSteps; ++i) {
      const double stamp = i * kStep;
      if (i % 10 == 0) streams.poses.push_back(pose(stamp, options));
      if (options.with_gyro)
        streams.gyro.push_back(
            {stamp, turn(stamp - options.gyro_late_s) + options.gyro_rad_s * unit_(draw_)});
      const double t = stamp - options.wheels_late_s;
      const double root = std::sqrt(std::abs(way(t) - before));
      before = way(t);
      for (double& d : drift) d += options.way_per_sqrt_m * root * unit_(draw_);
      const double half = 0.5 * kTrack * heading(t);
      streams.wheels.push_back(
          {stamp, (before - half + drift[0]) / kRadius, (before + half + drift[1]) / kRadius});
    }
    return streams;
  }

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(draw_);
  }

 private:
  struct Wave {
    double amplitude = 0.0, rate = 1.0, phase = 0.0;  // rate [rad/s]
  };
  static constexpr double kStep = 0.01;  // [s]
  static constexpr int kSteps = 7600;
  static constexpr double kRadius = 0.31;
  static constexpr double kTrack = 1.6;
  static constexpr double kMean = 4.0;  // [m/s]

  Wave wave(double low, double high, double slow_hz, double fast_hz) {
    return {uniform(low, high), 2.0 * std::numbers::pi * uniform(slow_hz, fast_hz),
            uniform(0.0, 2.0 * std::numbers::pi)};
  }
  template <typename Waves>
  static double sum(const Waves& waves, double t) {
    double s = 0.0;
    for (const Wave& w : waves) s += w.amplitude * std::sin(w.rate * t + w.phase);
    return s;
  }
  template <typename Waves>
  static double integral(const Waves& waves, double t) {
    double s = 0.0;
    for (const Wave& w : waves) s -= w.amplitude / w.rate * std::cos(w.rate * t + w.phase);
    return s;
  }
  [[nodiscard]] double speed(double t) const { return kMean + sum(speed_, t); }
  [[nodiscard]] double way(double t) const { return kMean * t + integral(speed_, t); }
  [[nodiscard]] double turn(double t) const { return sum(turn_, t); }
  [[nodiscard]] double heading(double t) const { return integral(turn_, t); }

  PoseSample pose(double stamp, const PlanarCarOptions& options) {
    const double t = stamp - options.poses_late_s;
    const double quarters = t / (0.25 * kStep);
    const auto i = static_cast<std::size_t>(quarters);
    const double part = quarters - static_cast<double>(i);
    return {stamp, x_[i] + part * (x_[i + 1] - x_[i]) + options.position_m * unit_(draw_),
            y_[i] + part * (y_[i + 1] - y_[i]) + options.position_m * unit_(draw_),
            heading(t) + options.heading_rad * unit_(draw_)};
  }

  std::mt19937_64 draw_;
  std::normal_distribution<double> unit_;
  std::array<Wave, 3> speed_;
  std::array<Wave, 4> turn_;
  std::vector<double> x_, y_;
  double dx_ = 0.0, dy_ = 0.0;
};

}  // namespace roadbook::test
