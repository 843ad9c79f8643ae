#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/diagnose.hpp"
#include "diagnosis/wheel_rows.hpp"
#include "tests/hidden_effects/recorded_streams.hpp"

namespace roadbook {
namespace {

const FoundCause* named(const Diagnosis& d, const std::string& effect) {
  for (const FoundCause& c : d.causes)
    if (c.effect == effect) return &c;
  return nullptr;
}

MotionStreams left_wheel_alone(const std::string& effect, double size) {
  test::HiddenDriveOptions hidden;
  hidden.seed = 41;
  if (!effect.empty()) hidden.secret[effect] = size;
  MotionStreams streams = test::streams_of(test::record_drive(hidden));
  streams.wheels_read = WheelsRead::kLeft;
  for (WheelSample& w : streams.wheels) w.right_rad = w.left_rad;
  return streams;
}

// Pythagoras: a front wheel on a circle of radius R about the rear axle's line rolls on one of
// hypot(R, wheelbase).
TEST(OneWheel, AFrontWheelRollsTheHypotenuse) {
  WheelModel model;
  model.wheelbase_m = 2.5;
  TrueMotion<double> arc;
  arc.turn_rad = 0.02;
  arc.distance_m = -6.0 * arc.turn_rad;  // backwards on a circle of 6 m
  const auto row = [&](double distance, double turn) {
    TrueMotion<double> m;
    m.distance_m = distance;
    m.turn_rad = turn;
    return predict_wheel_row(model, WheelsRead::kFront, {}, m).x();
  };
  EXPECT_NEAR(row(arc.distance_m, arc.turn_rad), -6.5 * arc.turn_rad, 1e-12);
  const Eigen::Matrix2d gain = wheel_row_gain(model, WheelsRead::kFront, {}, arc);
  constexpr double kStep = 1e-6;
  EXPECT_NEAR(
      gain(0, 0),
      (row(arc.distance_m + kStep, arc.turn_rad) - row(arc.distance_m, arc.turn_rad)) / kStep,
      1e-4);
  EXPECT_NEAR(
      gain(0, 1),
      (row(arc.distance_m, arc.turn_rad + kStep) - row(arc.distance_m, arc.turn_rad)) / kStep,
      1e-3);
}

// The outer wheel rolls farther: one wheel and poses tell of half the track.
TEST(OneWheel, TellsOfItsOwnRadiusAndOfTheTrackButNotOfTheOtherWheel) {
  const Diagnosis wide = diagnose(left_wheel_alone("wheels0.track_width", 0.05), "left");
  const FoundCause* track = named(wide, "wheels0.track_width");
  ASSERT_NE(track, nullptr);
  EXPECT_NEAR(track->size, 0.05, 0.75 * (track->high - track->low));
  const Diagnosis large = diagnose(left_wheel_alone("wheels0.left_radius", 0.01), "left");
  ASSERT_NE(named(large, "wheels0.left_radius"), nullptr);
  for (const std::string& name : large.looked_for) {
    EXPECT_NE(name, "wheels0.right_radius");
    EXPECT_NE(name, "wheels0.radius_difference");
  }
  const Diagnosis nothing = diagnose(left_wheel_alone("", 0.0), "left");
  EXPECT_TRUE(nothing.causes.empty() && nothing.unknown.empty());
}

TEST(PositionsAlone, ShowAGyrosScaleAndInventNothing) {
  test::HiddenDriveOptions hidden;
  hidden.seed = 42;
  const auto positions = [&] {
    MotionStreams streams = test::streams_of(test::record_drive(hidden));
    streams.poses_have_heading = false;
    return diagnose(streams, "positions");
  };
  const Diagnosis nothing = positions();
  EXPECT_TRUE(nothing.causes.empty() && nothing.unknown.empty());
  hidden.secret["imu0.gyro_scale"] = 0.02;
  const Diagnosis d = positions();
  const FoundCause* scale = named(d, "imu0.gyro_scale");
  ASSERT_NE(scale, nullptr);
  EXPECT_NEAR(scale->size, 0.02, 0.75 * (scale->high - scale->low));
}

// What stands in a set of names that fit alike was seen; it is not "not observable" as well.
TEST(Sets, AreNotListedAsNotObservable) {
  test::HiddenDriveOptions hidden;
  hidden.seed = 77;
  hidden.straight = true;
  hidden.secret["wheels0.radius"] = 0.02;
  const Diagnosis d = diagnose(test::streams_of(test::record_drive(hidden)), "straight");
  ASSERT_FALSE(d.causes.empty());
  ASSERT_FALSE(d.causes.front().inseparable.empty());
  for (const std::string& name : d.causes.front().inseparable)
    EXPECT_EQ(std::find(d.not_observable.begin(), d.not_observable.end(), name),
              d.not_observable.end())
        << name;
}

TEST(Without, LeavesOutANoiseEffectToo) {
  test::HiddenDriveOptions hidden;
  hidden.seed = 43;
  hidden.secret["imu0.outliers"] = 0.08;
  const MotionStreams streams = test::streams_of(test::record_drive(hidden));
  EXPECT_NE(named(diagnose(streams, "with"), "imu0.outliers"), nullptr);
  DiagnosisOptions options;
  options.library.without = {"imu0.outliers"};
  EXPECT_EQ(named(diagnose(streams, "without", options), "imu0.outliers"), nullptr);
}

}  // namespace
}  // namespace roadbook
