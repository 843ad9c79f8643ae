#include "sensors/wheels.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/random.hpp"
#include "sensors/wheel_imperfections.hpp"

namespace roadbook {
namespace {

// Ten seconds at 2 m/s on a circle of 20 m radius, readings every 20 ms.
std::vector<WheelReading> circle(const WheelModel& model) {
  std::vector<WheelReading> readings;
  for (int i = 0; i <= 500; ++i) {
    const double t = 0.02 * i;
    const double half = 0.5 * model.track_width_m;
    readings.push_back({i * 20'000'000LL, 0.1 * t * (20.0 - half) / model.radius_left_m,
                        0.1 * t * (20.0 + half) / model.radius_right_m, std::nullopt});
  }
  return readings;
}

TEST(WheelOdometry, FollowsACircleExactly) {
  const WheelModel model;
  const WheelOdometry odometry(model, circle(model));
  const auto motion = odometry.between(1'010'000'000, 8'770'000'000);
  ASSERT_TRUE(motion);
  const double turn = 0.1 * 7.76;
  EXPECT_NEAR(motion->motion.z(), turn, 1e-12);
  EXPECT_NEAR(motion->motion.x(), 20.0 * std::sin(turn), 1e-10);
  EXPECT_NEAR(motion->motion.y(), 20.0 * (1.0 - std::cos(turn)), 1e-10);
  EXPECT_NEAR(motion->distance_m, 2.0 * 7.76, 1e-10);
  EXPECT_FALSE(motion->reversing);
}

TEST(WheelOdometry, IsEmptyOutsideTheStreamAndOverAGap) {
  const WheelModel model;
  auto readings = circle(model);
  readings.erase(readings.begin() + 100, readings.begin() + 150);
  const WheelOdometry odometry(model, readings);
  EXPECT_FALSE(odometry.between(0, 10'020'000'000));
  EXPECT_FALSE(odometry.between(1'000'000'000, 5'000'000'000));
  EXPECT_TRUE(odometry.between(4'000'000'000, 5'000'000'000));
  // From or to a time within the gap of 1.98 to 3 s.
  EXPECT_FALSE(odometry.between(1'000'000'000, 2'500'000'000));
  EXPECT_FALSE(odometry.between(2'500'000'000, 4'000'000'000));
  EXPECT_TRUE(odometry.between(1'000'000'000, 1'980'000'000));
}

// Sum of 200 normalised squared errors of 3 degrees of freedom: chi-square of 600, 95 % band
// 600 +- 1.96 sqrt(1200).
TEST(WheelOdometry, CovarianceCoversTheErrors) {
  const WheelModel model;
  const auto clean = circle(model);
  const auto truth = WheelOdometry(model, clean).between(0, 10'000'000'000);
  ASSERT_TRUE(truth);
  double nees = 0.0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(7, "nees", seed);
    // The car slips while the wheels roll on: the noise goes to the true pose.
    Eigen::Vector3d pose = Eigen::Vector3d::Zero();
    for (std::size_t i = 1; i < clean.size(); ++i) {
      const double root = std::sqrt(0.04);
      const double d = 0.04 + model.sigma_distance_per_sqrt_m * root * random.normal();
      const double turn = 0.002 + model.sigma_heading_per_sqrt_m * root * random.normal();
      const double side = model.sigma_lateral_per_sqrt_m * root * random.normal();
      const double c = std::cos(pose.z() + 0.5 * turn);
      const double s = std::sin(pose.z() + 0.5 * turn);
      pose += Eigen::Vector3d(d * c - side * s, d * s + side * c, turn);
    }
    auto readings = clean;
    for (auto& reading : readings) {
      reading.left_angle_rad += model.sigma_angle_rad * random.normal();
      reading.right_angle_rad += model.sigma_angle_rad * random.normal();
    }
    const auto seen = WheelOdometry(model, readings).between(0, 10'000'000'000);
    ASSERT_TRUE(seen);
    const Eigen::Vector3d error = seen->motion - pose;
    nees += error.dot(truth->covariance.ldlt().solve(error));
  }
  EXPECT_NEAR(nees, 600.0, 1.96 * std::sqrt(1200.0));
}

TEST(WheelImperfections, NominalWheelsAreTheInverseOfTheOdometry) {
  const WheelModel model;
  TrueMotion<double> motion;
  motion.distance_m = 0.7;
  motion.turn_rad = -0.03;
  const auto turns = predict_wheel_turns<double>(model, {}, motion);
  const auto back = wheel_increment<double>(turns.x(), turns.y(), model.radius_left_m,
                                            model.radius_right_m, model.track_width_m);
  EXPECT_NEAR(back.x(), 0.7, 1e-14);
  EXPECT_NEAR(back.y(), -0.03, 1e-14);
}

TEST(WheelImperfections, ALargerRadiusTurnsTheWheelLess) {
  const WheelModel model;
  TrueMotion<double> motion;
  motion.distance_m = 3.0;
  const auto off = wheel_imperfections({{"wheels0.left_radius", 0.02}});
  const auto turns = predict_wheel_turns(model, off, motion);
  EXPECT_NEAR(turns.x(), 3.0 / (0.3 * 1.02), 1e-12);
  EXPECT_NEAR(turns.y(), 3.0 / 0.3, 1e-12);
}

}  // namespace
}  // namespace roadbook
