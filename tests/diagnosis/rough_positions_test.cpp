#include "tests/diagnosis/rough_positions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "diagnosis/diagnose.hpp"
#include "diagnosis/motion/motion_fit.hpp"
#include "diagnosis/streams/observe.hpp"

namespace roadbook {
namespace {

using test::with_rough_positions;

// The heading of the first trajectory against that of the car, which an exact recording of the same
// seed shows.
TEST(RoughPositions, TheFirstTrajectoryHasTheCoursesOfTheCar) {
  for (const double noise_m : {0.5, 2.0}) {
    test::PlanarCarOptions exact;
    exact.position_m = exact.heading_rad = 0.0;
    const MotionStreams car = test::PlanarCar(3).record(exact);
    const Observations obs = observe(with_rough_positions(3, noise_m, 1));
    const Trajectory first = trajectory_of_poses(obs);
    double squares = 0.0;
    for (const PoseSample& pose : car.poses)
      squares += std::pow(
          std::remainder(first.at(pose.t_s).heading - pose.heading, 2.0 * std::numbers::pi), 2);
    EXPECT_LT(std::sqrt(squares / static_cast<double>(car.poses.size())), 0.08) << noise_m;
  }
}

TEST(RoughPositions, ARadiusAndABiasAreNamedAndNothingElse) {
  for (const auto& [noise_m, every] : {std::pair{0.5, std::size_t{1}}, {0.5, 10}, {1.0, 1}}) {
    for (const double sign : {1.0, -1.0}) {
      MotionStreams streams = with_rough_positions(sign > 0 ? 5 : 6, noise_m, every);
      const double radius = sign * 0.04;
      const double bias = sign * 0.01;
      for (WheelSample& w : streams.wheels) {
        w.left_rad /= 1.0 + radius;
        w.right_rad /= 1.0 + radius;
      }
      for (GyroSample& g : streams.gyro) g.rate_rad_s += bias;
      const Diagnosis d = diagnose(streams, "drive");
      std::string names;
      for (const FoundCause& c : d.causes) {
        names += c.effect + " ";
        if (c.effect == "wheels0.radius") {
          EXPECT_GE(radius, c.low - 0.5 * (c.high - c.low));
          EXPECT_LE(radius, c.high + 0.5 * (c.high - c.low));
        }
        if (c.effect == "imu0.gyro_bias") {
          EXPECT_NEAR(c.size, bias, 0.002);
        }
      }
      EXPECT_NE(names.find("wheels0.radius "), std::string::npos)
          << names << noise_m << ' ' << every;
      EXPECT_NE(names.find("imu0.gyro_bias "), std::string::npos)
          << names << noise_m << ' ' << every;
      EXPECT_EQ(d.causes.size() + d.unknown.size(), 2U) << names << noise_m << ' ' << every;
    }
  }
}

TEST(RoughPositions, OfASoundCarRaiseNoAlarm) {
  for (std::uint64_t seed = 20; seed < 26; ++seed) {
    const Diagnosis d = diagnose(
        with_rough_positions(seed, seed % 2 == 0 ? 0.5 : 2.0, seed % 3 == 0 ? 10 : 1), "drive");
    EXPECT_TRUE(d.causes.empty()) << d.causes.front().effect << " seed " << seed;
    EXPECT_TRUE(d.unknown.empty()) << "seed " << seed;
  }
}

}  // namespace
}  // namespace roadbook
