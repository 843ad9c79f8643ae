#include "diagnosis/streams/level_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "diagnosis/diagnose.hpp"
#include "tests/diagnosis/planar_car.hpp"

namespace roadbook {
namespace {

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

HillDrive drive_over(const Hills& hills, std::uint64_t seed, double radius = 0.0) {
  HillDrive drive;
  drive.streams = test::PlanarCar(seed).record({});
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
    level_motion(drive.attitudes, drive.pitch_rates, drive.streams);
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

// Without levelling the hills are an error of the wheels' radius; with it there is none, and a true
// one is found in its size.
TEST(LevelMotion, HillsRaiseNoAlarmAndHideNoRadius) {
  int alarms_before = 0;
  for (std::uint64_t seed = 30; seed < 34; ++seed) {
    HillDrive drive = drive_over({}, seed);
    alarms_before += names_of(diagnose(drive.streams, "drive")).empty() ? 0 : 1;
    level_motion(drive.attitudes, drive.pitch_rates, drive.streams);
    EXPECT_EQ(names_of(diagnose(drive.streams, "drive")), "") << seed;
  }
  EXPECT_GE(alarms_before, 2);
  HillDrive drive = drive_over({}, 35, 0.03);
  level_motion(slopes_of(drive.streams.poses, drive.heights), {}, drive.streams);
  const Diagnosis d = diagnose(drive.streams, "drive");
  EXPECT_EQ(names_of(d), "wheels0.radius ");
  ASSERT_FALSE(d.causes.empty());
  EXPECT_LT(d.causes[0].low, 0.03);
  EXPECT_GT(d.causes[0].high, 0.03);
}

TEST(LevelMotion, OnThePlaneChangesNothing) {
  const MotionStreams plane = test::PlanarCar(3).record({});
  MotionStreams same = plane;
  level_motion({{0.0, 0.004, -0.003}, {100.0, -0.004, 0.003}}, {}, same);
  for (std::size_t i = 0; i < plane.wheels.size(); ++i)
    ASSERT_EQ(same.wheels[i].left_rad, plane.wheels[i].left_rad);
  for (std::size_t i = 0; i < plane.gyro.size(); ++i)
    ASSERT_EQ(same.gyro[i].rate_rad_s, plane.gyro[i].rate_rad_s);
}

}  // namespace
}  // namespace roadbook
