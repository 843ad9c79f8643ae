#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/motion/motion_fit.hpp"

namespace roadbook {
namespace {

// The drive is 40 s on a circle of 20 m. Poses are missing from 10 to 30 s, and within the gap the
// car is at rest for 10 s.
constexpr double kCircle = 20.0;
constexpr double kCircleSpeed = 3.0;
constexpr double kGapBegin = 10.0, kGapEnd = 30.0, kStop = 12.0, kGo = 22.0;

double driven(double t) { return kCircleSpeed * (t - std::clamp(t - kStop, 0.0, kGo - kStop)); }

Observations circle_with_a_gap() {
  Observations obs;
  obs.wheels_read = WheelsRead::kMiddle;
  for (double t = 0.0; t < 40.0; t += 0.08) {
    if (t > kGapBegin && t < kGapEnd) continue;
    const double turned = driven(t) / kCircle;
    obs.poses.push_back(
        {t, kCircle * std::sin(turned), kCircle * (1.0 - std::cos(turned)), turned});
  }
  return obs;
}

void add_speed(Observations& obs) {
  for (double t = 0.0; t < 40.0; t += 0.08) obs.wheels.push_back({t, driven(t), 0.0, 0.0, 0.0});
}
void add_steering(Observations& obs) {
  const double angle = std::atan(obs.wheel_model.wheelbase_m / kCircle);
  for (double t = 0.0; t < 40.0; t += 0.08) obs.steering.push_back({t, t + 0.06, angle, 4});
}

// Largest distance from the truth within the gap [m].
double farthest_off(const Observations& obs) {
  const Trajectory bridged = trajectory_of_poses(obs);
  double farthest = 0.0;
  for (double t = kGapBegin + 0.5; t < kGapEnd - 0.5; t += 0.5) {
    const MotionState s = bridged.at(t);
    const double turned = driven(t) / kCircle;
    farthest = std::max(farthest, std::hypot(s.x - kCircle * std::sin(turned),
                                             s.y - kCircle * (1.0 - std::cos(turned))));
  }
  return farthest;
}

TEST(PoseGapBridge, OneSpeedAndSteeringLeadAlongTheWayDriven) {
  Observations obs = circle_with_a_gap();
  add_speed(obs);
  add_steering(obs);
  // Of 30 m of way; stopping and starting fall between readings.
  EXPECT_LT(farthest_off(obs), 0.3);
}

// The turn is spread evenly over time, also at standstill: metres off, but usable.
TEST(PoseGapBridge, OneSpeedAloneTellsWhereTheCarStood) {
  Observations obs = circle_with_a_gap();
  add_speed(obs);
  EXPECT_LT(farthest_off(obs), 5.0);
  EXPECT_GT(farthest_off(obs), 1.0);
  const Trajectory bridged = trajectory_of_poses(obs);
  EXPECT_NEAR(bridged.at(0.5 * (kStop + kGo)).speed, 0.0, 1e-6);
  EXPECT_NEAR(bridged.at(kGapEnd - 3.0).speed, kCircleSpeed, 1e-6);
}

// A steering angle without a speed has no information: even spread between both sides.
TEST(PoseGapBridge, SteeringAloneLeavesTheMiddleOfBothSides) {
  Observations obs = circle_with_a_gap();
  add_steering(obs);
  const Trajectory bridged = trajectory_of_poses(obs);
  EXPECT_NEAR(bridged.at(0.5 * (kGapBegin + kGapEnd)).speed, kCircleSpeed, 0.05);
  EXPECT_LT(farthest_off(obs), kCircleSpeed * (kGo - kStop));
}

}  // namespace
}  // namespace roadbook
