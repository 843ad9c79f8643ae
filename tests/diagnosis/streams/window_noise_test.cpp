#include "diagnosis/streams/window_noise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/random.hpp"
#include "diagnosis/motion/motion_fit.hpp"
#include "diagnosis/numerics/correlation_about_line.hpp"
#include "diagnosis/streams/observe.hpp"

namespace roadbook {
namespace {

// Arcs and straights at 3.5 m/s in closed form; the turn rate jumps at every joint. Poses at 12.5
// Hz with white noise, a gyro at 100 Hz; a share of its readings has ten times the noise.
struct GyroNoise {
  double correlation = 0.0;
  double outliers = 0.0;
};

constexpr double kGyroSigma = 0.002;  // [rad/s]

MotionStreams arcs_and_straights(std::uint64_t seed, const GyroNoise& noise = {}) {
  constexpr double kCarSpeed = 3.5;
  Random random(seed, "arcs and straights");
  MotionStreams streams;
  double x = 0.0, y = 0.0, heading = 0.0, t = 0.0, error = 0.0;
  const auto gyro_error = [&] {
    const double r = noise.correlation;
    error = r * error + kGyroSigma * std::sqrt(1.0 - r * r) * random.normal();
    const bool far = noise.outliers > 0.0 && random.uniform() < noise.outliers;
    return error + (far ? 10.0 * kGyroSigma * random.normal() : 0.0);
  };
  for (int piece = 0; piece < 40; ++piece) {
    const bool straight = piece % 2 == 0;
    const double turn = (random.uniform() < 0.5 ? -1.0 : 1.0) * random.uniform(0.5, 1.9);
    const double rate = straight ? 0.0 : kCarSpeed / std::copysign(random.uniform(5.0, 9.0), turn);
    const double end = t + (straight ? random.uniform(6.0, 20.0) / kCarSpeed : turn / rate);
    const auto after = [&](double tau) {
      const double chord =
          rate == 0.0 ? kCarSpeed * tau : 2.0 * kCarSpeed / rate * std::sin(0.5 * rate * tau);
      const double towards = heading + 0.5 * rate * tau;
      return PoseSample{t + tau, x + chord * std::cos(towards), y + chord * std::sin(towards),
                        heading + rate * tau};
    };
    for (auto k = static_cast<int>(std::ceil(t / 0.01)); 0.01 * k < end; ++k) {
      streams.gyro.push_back({0.01 * k, rate + gyro_error()});
      if (k % 8 != 0) continue;
      PoseSample p = after(0.01 * k - t);
      p.x += 0.02 * random.normal();
      p.y += 0.02 * random.normal();
      p.heading += 0.002 * random.normal();
      streams.poses.push_back(p);
    }
    const PoseSample next = after(end - t);
    t = end;
    x = next.x;
    y = next.y;
    heading = next.heading;
  }
  return streams;
}

// A jump within a window resembles autocorrelated readings. At most one drive in a thousand may
// have a false alarm.
TEST(WindowNoise, ATurnRateThatJumpsIsNoNoise) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const Observations obs = observe(arcs_and_straights(seed));
    std::vector<NoiseCause> all;
    append_window_noise("imu0", obs.gyro, smoothed(trajectory_of_poses(obs)), {}, all);
    EXPECT_EQ(all.size(), 4U);
    for (const NoiseCause& c : all)
      EXPECT_FALSE(is_sure(c)) << c.effect << " " << c.z << ", " << seed;
  }
}

// The standard error of a slow mean of correlated noise is that of white noise times sqrt((1 + r) /
// (1 - r)); outliers are white.
TEST(WindowNoise, WhatGoesOnIsToldBesideOutliers) {
  constexpr double kCorrelation = 0.7;
  constexpr double kReadings = 8.0;  // of a window
  for (std::uint64_t seed = 0; seed < 6; ++seed)
    for (const double share : {0.0, 0.02, 0.05}) {
      const double slow =
          kGyroSigma *
          std::sqrt(((1.0 + kCorrelation) / (1.0 - kCorrelation) + 100.0 * share) / kReadings);
      const Observations obs = observe(arcs_and_straights(seed, {kCorrelation, share}));
      const double told = slow_noise_of_mean(obs.gyro, smoothed(trajectory_of_poses(obs)));
      EXPECT_GT(told, 0.9 * slow) << seed << ", " << share;
      EXPECT_LT(told, 1.7 * slow) << seed << ", " << share;
    }
}

// With strong correlation the sample value can exceed the largest possible one. The uncertainty at
// the bound equals that next to it.
TEST(WindowNoise, ACorrelationAtItsBoundIsNotCertain) {
  const std::size_t count = 8;
  const auto correlation_of = [&](double ratio) {
    std::vector<WindowObservation> windows(200, {0.0, 0.08, 0.0, count, 1.0, ratio});
    for (std::size_t i = 0; i < windows.size(); ++i) windows[i].lagged += i % 2 == 0 ? 0.3 : -0.3;
    std::vector<const WindowObservation*> all;
    for (const WindowObservation& w : windows) all.push_back(&w);
    return correlation_in("imu0", all);
  };
  const NoiseCause at = correlation_of(ratio_of_correlation(0.99, count));
  const NoiseCause beyond = correlation_of(ratio_of_correlation(0.99, count) + 0.1);
  EXPECT_NEAR(beyond.size, 0.99, 1e-6);
  EXPECT_NEAR(beyond.sigma, at.sigma, 1e-6);
  EXPECT_GT(beyond.sigma, 0.05);
}

}  // namespace
}  // namespace roadbook
