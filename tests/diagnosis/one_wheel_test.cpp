#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/random.hpp"
#include "diagnosis/diagnose.hpp"
#include "diagnosis/streams/wheel_rows.hpp"
#include "tests/diagnosis/hidden_effects/recorded_streams.hpp"
#include "tests/support/found_causes.hpp"

namespace roadbook {
namespace {

using test::cause_named;

MotionStreams left_wheel_alone(const std::string& effect, double size) {
  test::HiddenDriveOptions hidden;
  hidden.seed = 41;
  if (!effect.empty()) hidden.secret[effect] = size;
  MotionStreams streams = test::streams_of(test::record_drive(hidden));
  streams.wheels_read = WheelsRead::kLeft;
  for (WheelSample& w : streams.wheels) w.right_rad = w.left_rad;
  return streams;
}

// A front wheel rolls on a circle of radius hypot(R, wheelbase) if the rear axle's middle is on a
// circle of radius R.
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

// One wheel and poses determine half of the track width, because the outer wheel rolls farther.
TEST(OneWheel, TellsOfItsOwnRadiusAndOfTheTrackButNotOfTheOtherWheel) {
  const Diagnosis wide = diagnose(left_wheel_alone("wheels0.track_width", 0.05), "left");
  const FoundCause* track = cause_named(wide, "wheels0.track_width");
  ASSERT_NE(track, nullptr);
  EXPECT_NEAR(track->size, 0.05, 0.75 * (track->high - track->low));
  const Diagnosis large = diagnose(left_wheel_alone("wheels0.left_radius", 0.01), "left");
  ASSERT_NE(cause_named(large, "wheels0.left_radius"), nullptr);
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
  const FoundCause* scale = cause_named(d, "imu0.gyro_scale");
  ASSERT_NE(scale, nullptr);
  EXPECT_NEAR(scale->size, 0.02, 0.75 * (scale->high - scale->low));
}

bool starts_with_any(const std::string& name, const std::vector<std::string>& streams) {
  return std::any_of(streams.begin(), streams.end(),
                     [&](const std::string& s) { return name.starts_with(s); });
}

// Without wheels and steering the effects of the gyro are found. The report says that distances are
// not observable, and no effect of a missing stream is searched for.
TEST(GyroAlone, FindsItsOwnFaultsAndSaysThatNothingTellsOfDistances) {
  for (const char* effect : {"", "imu0.gyro_scale"}) {
    test::HiddenDriveOptions hidden;
    hidden.seed = 43;
    if (*effect != 0) hidden.secret[effect] = 0.02;
    MotionStreams streams = test::streams_of(test::record_drive(hidden));
    streams.wheels.clear();
    streams.steering.clear();
    const Diagnosis d = diagnose(streams, "gyro");
    for (const UnknownCause& u : d.unknown)
      ADD_FAILURE() << u.stream << "." << u.hook << " ~ " << u.depends_on;
    ASSERT_EQ(d.causes.size(), hidden.secret.size());
    if (*effect != 0) {
      EXPECT_EQ(d.causes[0].effect, effect);
      EXPECT_NEAR(d.causes[0].size, 0.02, 0.75 * (d.causes[0].high - d.causes[0].low));
    }
    for (const std::string& name : d.looked_for)
      EXPECT_FALSE(starts_with_any(name, {"wheels0", "steering0"})) << name;
    const auto said = [&](const std::string& note) {
      return std::find(d.notes.begin(), d.notes.end(), note) != d.notes.end();
    };
    EXPECT_TRUE(said("wheels not diagnosed: no stream"));
    EXPECT_TRUE(said("lengths (scale of the map) not diagnosed: no wheels"));
    EXPECT_NE(std::find(d.not_observable.begin(), d.not_observable.end(), "map.scale"),
              d.not_observable.end());
  }
}

TEST(SteeringAlone, FindsItsOffset) {
  test::HiddenDriveOptions hidden;
  hidden.seed = 44;
  hidden.secret["steering0.offset"] = 0.01;
  MotionStreams streams = test::streams_of(test::record_drive(hidden));
  streams.wheels.clear();
  streams.gyro.clear();
  const Diagnosis d = diagnose(streams, "steering");
  ASSERT_EQ(d.causes.size(), 1U);
  EXPECT_EQ(d.causes[0].effect, "steering0.offset");
  EXPECT_NEAR(d.causes[0].size, 0.01, 0.75 * (d.causes[0].high - d.causes[0].low));
}

// Poses of a map drift by centimetres over tens of metres; neighbours agree to millimetres.
TEST(PosesOfAMap, ThatDriftSlowlyInventNothing) {
  test::HiddenDriveOptions hidden;
  hidden.seed = 45;
  hidden.length_m = 150.0;
  MotionStreams streams = test::streams_of(test::record_drive(hidden));
  streams.poses_of_map = true;
  Random random(7);
  double x = 0.0, y = 0.0, heading = 0.0;
  for (PoseSample& p : streams.poses) {
    x += 2e-3 * random.normal() - 1e-3 * x;
    y += 2e-3 * random.normal() - 1e-3 * y;
    heading += 2e-4 * random.normal() - 1e-3 * heading;
    p.x += x;
    p.y += y;
    p.heading += heading;
  }
  // Effects that the views of the map have decided.
  DiagnosisOptions options;
  options.library.without = {"cam.latency", "cam.rotation", "cam.position", "map.scale",
                             "map.bend"};
  const Diagnosis d = diagnose(streams, "map", options);
  for (const FoundCause& c : d.causes) ADD_FAILURE() << c.effect << " " << c.size;
  for (const UnknownCause& u : d.unknown)
    ADD_FAILURE() << u.stream << "." << u.hook << " ~ " << u.depends_on;
}

// A member of an equivalence set is not listed as not observable.
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
  EXPECT_NE(cause_named(diagnose(streams, "with"), "imu0.outliers"), nullptr);
  DiagnosisOptions options;
  options.library.without = {"imu0.outliers"};
  EXPECT_EQ(cause_named(diagnose(streams, "without", options), "imu0.outliers"), nullptr);
}

}  // namespace
}  // namespace roadbook
