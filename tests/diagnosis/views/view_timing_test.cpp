#include "diagnosis/views/view_timing.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace roadbook {
namespace {

constexpr double kTrueSpeed = 2.5;         // [m/s]
constexpr double kTrueYawRate = 0.3;       // [rad/s]
constexpr double kTrueAcceleration = 0.4;  // [m/s^2]

// One keyframe with these rates of the wheels [rad/s], as a nominal car measures them.
ViewData keyframe_reading(double left, double right) {
  ViewData data;
  const WheelModel& w = data.wheels;
  ViewMoment& m = data.moments.emplace_back();
  m.speed = 0.5 * (left * w.radius_left_m + right * w.radius_right_m);
  m.yaw_rate = (right * w.radius_right_m - left * w.radius_left_m) / w.track_width_m;
  m.acceleration = kTrueAcceleration;
  m.read_by_wheels = true;
  return data;
}

// By hand: a wheel rolls the distance of its side of the axle on its own radius, and turns more by
// slip.
TEST(ViewTiming, TakesOffTheRatesWhatTheWheelsReadTooMuch) {
  const WheelModel w;
  const double half_track = 0.5 * 1.03 * w.track_width_m;
  const double slip = 1.0 + 0.005 * kTrueAcceleration;
  const double left =
      slip * (kTrueSpeed - half_track * kTrueYawRate) / (w.radius_left_m * (1.0 + 0.02));
  const double right =
      slip * (kTrueSpeed + half_track * kTrueYawRate) / (w.radius_right_m * (1.0 - 0.01));
  const ViewData data = keyframe_reading(left, right);
  EXPECT_GT(std::abs(data.moments[0].yaw_rate - kTrueYawRate), 0.02);
  const ViewTiming timing(data, {{"wheels0.left_radius", 0.02},
                                 {"wheels0.right_radius", -0.01},
                                 {"wheels0.track_width", 0.03},
                                 {"wheels0.slip_acceleration", 0.005}});
  const Vector6d xi = timing.twist(0, 0.0);
  EXPECT_NEAR(xi[0], kTrueSpeed, 1e-9);
  EXPECT_NEAR(xi[5], kTrueYawRate, 1e-9);
}

// What is stated of a camera, or what the map has not yet moved its corners by, adds to the
// effects.
TEST(ViewTiming, StatedTimesOfACameraAddToTheEffects) {
  ViewData data;
  MountedCamera& camera = data.bundle.cameras.emplace_back();
  camera.name = "cam0";
  camera.camera.height = 100;
  camera.exposed_after_s = -0.03;
  camera.rolling_shutter_s = 0.02;
  const ViewTiming timing(data, {{"cam0.latency", 0.01}, {"cam.rolling_shutter", 0.005}});
  EXPECT_NEAR(timing.after_stamp(camera.camera, 0, 49.5), -0.04, 1e-12);
  EXPECT_NEAR(timing.after_stamp(camera.camera, 0, 99.5), -0.04 + 0.5 * 0.025, 1e-12);
}

// Late wheels read earlier motion; its mean over [0, dt] is that at dt / 2.
TEST(ViewTiming, LateWheelsReadAnEarlierMotion) {
  constexpr double kLate = 0.05;
  ViewData data = keyframe_reading(0.0, 0.0);
  data.moments[0].speed = kTrueSpeed - kLate * kTrueAcceleration;
  const ViewTiming timing(data, {{"wheels0.latency", kLate}});
  EXPECT_NEAR(timing.twist(0, 0.2)[0], kTrueSpeed + 0.1 * kTrueAcceleration, 1e-9);
}

// The wheels of a spool contain no turns.
TEST(ViewTiming, LeavesRatesThatWheelsDoNotTell) {
  ViewData spool = keyframe_reading(8.0, 8.0);
  EXPECT_EQ(ViewTiming(spool, {{"wheels0.locked_axle", 1.0}}).twist(0, 0.0)[0],
            spool.moments[0].speed);
  ViewData by_poses = keyframe_reading(8.0, 8.5);
  by_poses.moments[0].read_by_wheels = false;
  EXPECT_EQ(ViewTiming(by_poses, {{"wheels0.radius", 0.02}}).twist(0, 0.0)[0],
            by_poses.moments[0].speed);
}

}  // namespace
}  // namespace roadbook
