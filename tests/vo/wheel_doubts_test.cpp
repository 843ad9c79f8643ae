#include "vo/wheels/wheel_doubts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/vo/wheel_drive.hpp"

namespace roadbook::test {
namespace {

using Fault = std::function<void(std::vector<WheelReading>&, WheelModel&)>;

WheelComparison compared(const Fault& fault) {
  WheelModel model;
  auto readings = readings_of(model);
  fault(readings, model);
  return compare_wheels(sight_of(), WheelOdometry(model, std::move(readings)), std::nullopt);
}

TEST(CompareWheels, SoundWheelsAreNotDoubted) {
  const auto sound = compared([](auto&, auto&) {});
  EXPECT_TRUE(sound.doubts.empty());
  EXPECT_NEAR(sound.turn_factor.value(), 1.0, 0.03);
  EXPECT_FALSE(sound.way_factor);  // no corners: no ground
}

// Radius, track and time of honest wheels are a few percent and some hundredths of a second off.
TEST(CompareWheels, UsualErrorsAreNotDoubted) {
  EXPECT_TRUE(compared([](auto&, WheelModel& m) { m.track_width_m *= 1.05; }).doubts.empty());
  EXPECT_TRUE(compared([](auto&, WheelModel& m) {
                m.radius_left_m *= 1.02;
                m.radius_right_m *= 1.02;
              }).doubts.empty());
  EXPECT_TRUE(compared([](auto&, WheelModel& m) { m.radius_left_m *= 1.005; }).doubts.empty());
}

// One wheel or both do not turn for half a second and more: the time is found within 0.4 s at both
// ends, and the way that is missing.
TEST(CompareWheels, AWheelThatStandsIsFoundWhenItStands) {
  for (const double seconds : {0.5, 2.0, 5.0})
    for (const int wheels : {1, 2, 3}) {
      const bool left = (wheels & 1) != 0;
      const bool right = (wheels & 2) != 0;
      const auto c =
          compared([&](auto& readings, auto&) { hold(readings, 12.0, seconds, left, right); });
      SCOPED_TRACE(std::to_string(seconds) + " s, wheels " + std::to_string(wheels));
      ASSERT_EQ(c.doubts.size(), 1U);
      EXPECT_NEAR(static_cast<double>(c.doubts[0].span.first) * 1e-9, 12.0, 0.4);
      EXPECT_NEAR(static_cast<double>(c.doubts[0].span.second) * 1e-9, 12.0 + seconds, 0.4);
      const double missing = kSpeed_m_s * seconds * (left && right ? 1.0 : 0.5);
      // In a bend one wheel drives a tenth more or less than the middle of the axle.
      EXPECT_NEAR(c.doubts[0].way_m, -missing, 0.1 * missing + 0.1);
      if (left != right) {
        EXPECT_EQ(c.doubts[0].turn_rad > 0.0, left);
      }
      EXPECT_FALSE(c.doubts_all());
    }
}

TEST(CompareWheels, ALostCountIsFound) {
  for (const double jump_rad : {3.0, -30.0}) {
    const auto c = compared([&](auto& readings, auto&) {
      for (std::size_t i = 1000; i < readings.size(); ++i) readings[i].left_angle_rad += jump_rad;
    });
    ASSERT_EQ(c.doubts.size(), 1U);
    EXPECT_LE(c.doubts[0].span.first, 20'000'000'000);
    EXPECT_GE(c.doubts[0].span.second, 20'000'000'000);
    EXPECT_LT(c.doubts[0].span.second - c.doubts[0].span.first, 1'000'000'000);
  }
}

TEST(CompareWheels, WhatIsWrongThroughoutLeavesTheWheelsOut) {
  const auto swapped = compared([](auto& readings, auto&) {
    for (auto& r : readings) std::swap(r.left_angle_rad, r.right_angle_rad);
  });
  EXPECT_TRUE(swapped.doubts_all());
  EXPECT_NEAR(swapped.turn_factor.value(), -1.0, 0.03);
  const auto half_track = compared([](auto&, WheelModel& m) { m.track_width_m *= 0.5; });
  EXPECT_TRUE(half_track.doubts_all());
  EXPECT_NEAR(half_track.turn_factor.value(), 2.0, 0.06);
  const auto reversed = compared([](auto& readings, auto&) {
    for (auto& r : readings) r.right_angle_rad = -r.right_angle_rad;
  });
  EXPECT_TRUE(reversed.doubts_all());
  const auto half = compared([](auto& readings, auto&) { hold(readings, 20.0, 19.9, true, true); });
  EXPECT_TRUE(half.doubts_all());
}

// The wheels roll for 4 s in frames of 0.1 s. The cameras know the motion but from 1 to 2 s.
TEST(KnownShare, IsTheTimeWithoutTheGapsOfTheCameras) {
  const WheelModel model;
  const WheelOdometry wheels(model, readings_of(model));
  std::vector<std::int64_t> frames_ns;
  VoResult sight;
  for (int i = 0; i <= 40; ++i) {
    frames_ns.push_back(std::int64_t{i} * 100'000'000);
    if (i > 10 && i < 20) continue;
    VoKeyframe keyframe;
    keyframe.t_ns = frames_ns.back();
    keyframe.inliers = 200;
    keyframe.after_gap = i == 20;
    sight.keyframes.push_back(keyframe);
  }
  EXPECT_NEAR(known_share(sight, wheels, frames_ns), 0.75, 1e-9);
  EXPECT_EQ(known_share({}, wheels, frames_ns), 0.0);
}

}  // namespace
}  // namespace roadbook::test
