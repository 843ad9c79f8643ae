#include "sensors/correction.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace roadbook {
namespace {

constexpr double kRadiusM = 0.3;
constexpr double kSteering = 0.1;

double speed_at(double t_s) { return 1.0 + 4.0 * t_s; }

// Readings at 100 Hz of a car that accelerates at 4 m/s^2 for one second. The wheels' radius grows
// by `grows` and the steering's understeer by `understeer`, as the effects define them.
std::vector<WheelReading> accelerating(double grows, double understeer) {
  std::vector<WheelReading> readings;
  double angle = 0.0;
  for (int i = 0; i <= 100; ++i) {
    if (i > 0) {
      const double speed = speed_at(0.01 * i - 0.005);
      angle += 0.01 * speed / (kRadiusM * (1.0 + grows * speed));
    }
    const double speed = speed_at(0.01 * i);
    readings.push_back(
        {10'000'000LL * i, angle, angle, kSteering * (1.0 + understeer * speed * speed)});
  }
  return readings;
}

WheelModel equal_wheels() {
  WheelModel model;
  model.radius_left_m = model.radius_right_m = kRadiusM;
  return model;
}

// The stated window of 0.4 s reaches equally far to both sides, so the speed is exact at constant
// acceleration. 0.2 s from the ends there is less.
TEST(Correction, SteeringIsCorrectedBySpeedOfItsOwnTime) {
  const EffectSizes sizes{{"steering0.understeer", 0.002}};
  const auto right = corrected_readings(equal_wheels(), sizes, 0, accelerating(0.0, 0.002));
  for (std::size_t i = 21; i + 21 < right.size(); ++i)
    EXPECT_NEAR(*right[i].steering_rad, kSteering, 1e-9) << i;
}

TEST(Correction, GrowthOfTheWheelsIsTakenOutWhileTheCarAccelerates) {
  constexpr double kGrows = 0.002;
  const EffectSizes sizes{{"wheels0.radius_speed", kGrows}};
  const auto right = corrected_readings(equal_wheels(), sizes, 0, accelerating(kGrows, 0.0));
  // The speed comes from the grown wheels: it errs by a share of kGrows * speed, and moves the
  // distance by the square of this. 5 m/s is the highest speed.
  const double tolerance = 1.5 * std::pow(kGrows * 5.0, 2);
  for (std::size_t i = 22; i + 21 < right.size(); ++i) {
    const double way = kRadiusM * (right[i].left_angle_rad - right[i - 1].left_angle_rad);
    const double truth = 0.01 * speed_at(0.01 * static_cast<double>(i) - 0.005);
    EXPECT_NEAR(way / truth, 1.0, tolerance) << i;
  }
}

}  // namespace
}  // namespace roadbook
