#include "diagnosis/streams/level_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "diagnosis/diagnose.hpp"
#include "tests/diagnosis/hill_car.hpp"

namespace roadbook {
namespace {

using test::drive_over;
using test::HillDrive;
using test::Hills;

std::string names_of(const Diagnosis& d) {
  std::string names;
  for (const FoundCause& c : d.causes) names += c.effect + " ";
  for (const UnknownCause& u : d.unknown) names += u.stream + "." + u.hook + " ";
  return names;
}

// The streams of a car on hills, levelled, are those of the same car on the plane.
TEST(LevelMotion, GivesTheReadingsOfThePlane) {
  for (const double bank : {0.0, 0.2, -0.2}) {
    Hills hills;
    hills.bank_rad = bank;
    const MotionStreams plane = test::PlanarCar(1).record({});
    HillDrive drive = drive_over(hills, 1);
    EXPECT_GT(drive.streams.wheels.back().left_rad, 1.002 * plane.wheels.back().left_rad);
    level_motion(drive.attitudes, drive.attitudes, drive.pitch_rates, drive.streams);
    double worst_rate = 0.0;
    for (std::size_t i = 5; i + 5 < plane.gyro.size(); ++i)
      worst_rate = std::max(worst_rate,
                            std::abs(drive.streams.gyro[i].rate_rad_s - plane.gyro[i].rate_rad_s));
    EXPECT_LT(worst_rate, 2e-3) << bank;
    const double turns = plane.wheels.back().left_rad - plane.wheels.front().left_rad;
    EXPECT_NEAR(drive.streams.wheels.back().left_rad, plane.wheels.back().left_rad, 2e-4 * turns);
    EXPECT_NEAR(drive.streams.wheels.back().right_rad, plane.wheels.back().right_rad, 2e-4 * turns);
  }
}

TEST(LevelMotion, SlopesFollowFromHeightsAndRoughOnesFromLongerLines) {
  const Hills hills;
  const HillDrive drive = drive_over(hills, 2);
  const auto off = [&](const std::vector<Attitude>& slopes) {
    double squares = 0.0;
    for (std::size_t i = 0; i < slopes.size(); ++i)
      squares += std::pow(slopes[i].slope_rad - drive.attitudes[i].slope_rad, 2);
    return std::sqrt(squares / static_cast<double>(slopes.size()));
  };
  EXPECT_LT(off(slopes_of(drive.streams.poses, drive.heights)), 0.012);
  std::mt19937 draw(1);
  std::normal_distribution<double> noise(0.0, 0.1);
  std::vector<double> rough = drive.heights;
  for (double& h : rough) h += noise(draw);
  EXPECT_LT(off(slopes_of(drive.streams.poses, rough)), 0.02);
}

// Without levelling, hills look like an error of the wheels' radius. With levelling no error is
// named, and a radius that is really wrong is found with its size.
TEST(LevelMotion, HillsRaiseNoAlarmAndHideNoRadius) {
  int alarms_before = 0;
  for (std::uint64_t seed = 30; seed < 33; ++seed) {
    HillDrive drive = drive_over({}, seed);
    alarms_before += names_of(diagnose(drive.streams, "drive")).empty() ? 0 : 1;
    level_motion(drive.attitudes, drive.attitudes, drive.pitch_rates, drive.streams);
    EXPECT_EQ(names_of(diagnose(drive.streams, "drive")), "") << seed;
  }
  EXPECT_GE(alarms_before, 2);
  const auto radius_of = [](const MotionStreams& streams) {
    const Diagnosis d = diagnose(streams, "drive");
    EXPECT_EQ(names_of(d), "wheels0.radius ");
    return d.causes.empty() ? FoundCause{} : d.causes.front();
  };
  HillDrive drive = drive_over({}, 35, 0.03);
  MotionStreams by_heights = drive.streams;
  level_motion(drive.attitudes, drive.attitudes, drive.pitch_rates, drive.streams);
  const FoundCause exact = radius_of(drive.streams);
  EXPECT_LT(exact.low, 0.03);
  EXPECT_GT(exact.high, 0.03);
  // Lines over heights flatten the tops of hills a little.
  const auto slopes = slopes_of(by_heights.poses, drive.heights);
  level_motion(slopes, slopes, {}, by_heights);
  EXPECT_NEAR(radius_of(by_heights).size, 0.03, 0.001);
}

TEST(LevelMotion, OnThePlaneChangesNothing) {
  const MotionStreams plane = test::PlanarCar(3).record({});
  MotionStreams same = plane;
  const std::vector<Attitude> level{{0.0, 0.004, -0.003}, {100.0, -0.004, 0.003}};
  level_motion(level, level, {}, same);
  const std::vector<Attitude> no_road{{0.0, 1.2, 0.0}, {100.0, 1.2, 0.0}};
  level_motion(no_road, no_road, {}, same);
  for (std::size_t i = 0; i < plane.wheels.size(); ++i)
    ASSERT_EQ(same.wheels[i].left_rad, plane.wheels[i].left_rad);
  for (std::size_t i = 0; i < plane.gyro.size(); ++i)
    ASSERT_EQ(same.gyro[i].rate_rad_s, plane.gyro[i].rate_rad_s);
}

}  // namespace
}  // namespace roadbook
