#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/random.hpp"
#include "diagnosis/diagnose.hpp"
#include "diagnosis/reading_diagnosis.hpp"
#include "diagnosis/stream_checks.hpp"
#include "diagnosis/streams/observations.hpp"
#include "diagnosis/streams/observe.hpp"
#include "tests/diagnosis/hidden_effects/recorded_streams.hpp"
#include "tests/support/expect_words.hpp"

namespace roadbook {
namespace {

using test::expect_words;

MotionStreams good() {
  test::HiddenDriveOptions options;
  options.length_m = 60.0;
  return test::streams_of(test::record_drive(options));
}

std::string refusal(const MotionStreams& streams) {
  try {
    static_cast<void>(diagnose(streams, "drive"));
  } catch (const BadInput& error) {
    return error.what();
  }
  return "accepted";
}

TEST(BadStreams, ADriveThatIsTooShortIsRefused) {
  MotionStreams streams = good();
  streams.poses.resize(20);
  expect_words(refusal(streams), "duration: got ");
}

TEST(BadStreams, ACarThatStandsIsRefused) {
  MotionStreams streams = good();
  for (PoseSample& p : streams.poses) p.x = p.y = p.heading = 0.0;
  expect_words(refusal(streams), "a drive, not a standing car");
}

TEST(BadStreams, OneStreamAloneIsRefused) {
  MotionStreams streams = good();
  streams.wheels.clear();
  streams.steering.clear();
  streams.gyro.clear();
  expect_words(refusal(streams), "poses alone");
  streams = good();
  streams.poses.clear();
  expect_words(refusal(streams), "needed for every diagnosis");
}

TEST(BadStreams, ANumberThatIsNoneNamesItsSample) {
  MotionStreams streams = good();
  streams.gyro[4].rate_rad_s = std::numeric_limits<double>::quiet_NaN();
  expect_words(refusal(streams), "imu0 sample 5");
}

TEST(BadStreams, ACalibrationThatCannotBeIsRefused) {
  MotionStreams streams = good();
  streams.wheel_model.track_width_m = -1.5;
  expect_words(refusal(streams), "wheels0.track_width: got -1.5");
  streams = good();
  streams.wheel_model.wheelbase_m = 0.0;
  expect_words(refusal(streams), "wheels0.wheelbase: got 0.0");
}

// A car at constant speed without bends: effects of either covariate are not observable.
TEST(BadStreams, ACovariateThatDoesNotVaryIsSaid) {
  MotionStreams streams;
  streams.wheel_model = good().wheel_model;
  Random random(3);
  for (int k = 0; k < 1500; ++k) {
    const double t = 0.04 * k;
    const double turn = 3.0 * t / streams.wheel_model.radius_left_m;
    streams.wheels.push_back({t, turn, turn});
    streams.gyro.push_back({t, 0.002 * random.normal()});
    streams.poses.push_back(
        {t, 3.0 * t + 0.02 * random.normal(), 0.02 * random.normal(), 0.002 * random.normal()});
  }
  const Diagnosis d = diagnose(streams, "drive");
  EXPECT_TRUE(d.causes.empty());
  EXPECT_TRUE(d.unknown.empty());
  std::string notes;
  for (const std::string& note : d.notes) notes += note + "; ";
  expect_words(notes, "speed does not vary: effects that depend on speed are not observable");
  expect_words(notes, "no bends");
}

TEST(BadStreams, GapsAreNotedAndNothingIsInvented) {
  MotionStreams streams = good();
  const double from = 0.4 * streams.poses.back().t_s;
  const auto inside = [from](const auto& s) { return s.t_s > from && s.t_s < from + 2.0; };
  std::erase_if(streams.wheels, inside);
  std::erase_if(streams.steering, inside);
  std::erase_if(streams.gyro, inside);
  const Diagnosis d = diagnose(streams, "drive");
  EXPECT_TRUE(d.causes.empty());
  EXPECT_TRUE(d.unknown.empty());
  ASSERT_EQ(d.notes.size(), 3U);
  expect_words(d.notes[0], "1 gap in wheels0, of ");
  expect_words(d.notes[1], "1 gap in imu0, of ");
  expect_words(d.notes[2], "no residual checks of wheels0 (distance)");
}

// Streams without poses for `length_s` from each of the times `at`, given as shares of the drive.
MotionStreams with_pose_gaps(std::uint64_t seed, const std::vector<double>& at, double length_s) {
  test::HiddenDriveOptions options;
  options.length_m = 60.0;
  options.seed = seed;
  MotionStreams streams = test::streams_of(test::record_drive(options));
  const double end = streams.poses.back().t_s;
  for (const double share : at)
    std::erase_if(streams.poses, [&](const PoseSample& p) {
      return p.t_s > share * end && p.t_s < share * end + length_s;
    });
  return streams;
}

void expect_nothing_found(const MotionStreams& streams, const std::string& what) {
  const Diagnosis d = diagnose(streams, "drive");
  for (const auto& c : d.causes) ADD_FAILURE() << what << ": " << c.effect;
  for (const auto& u : d.unknown) ADD_FAILURE() << what << ": unknown in " << u.stream;
}

TEST(BadStreams, OfAGapInThePosesNothingIsInvented) {
  for (const std::uint64_t seed : {1, 2, 3})
    for (const double at : {0.2, 0.45, 0.7})
      for (const double length_s : {5.4, 8.0})
        expect_nothing_found(with_pose_gaps(seed, {at}, length_s),
                             "seed " + std::to_string(seed) + ", " + std::to_string(length_s) +
                                 " s from " + std::to_string(at) + " on");
  expect_nothing_found(with_pose_gaps(4, {0.15, 0.5, 0.75}, 5.0), "three gaps");
}

// A circle at 1 rad/s: five seconds are most of a turn.
TEST(BadStreams, HeadingsGoOnOverAGapByWhatTheCarTurned) {
  MotionStreams streams;
  for (int k = 0; k < 500; ++k) {
    const double t = 0.04 * k;
    streams.gyro.push_back({t, 1.0});
    if (t > 5.0 && t < 10.0) continue;
    streams.poses.push_back(
        {t, std::sin(t), 1.0 - std::cos(t), std::remainder(t, 2.0 * std::numbers::pi)});
  }
  const Observations obs = observe(streams);
  for (const PoseSample& p : obs.poses) EXPECT_NEAR(p.heading, p.t_s, 1e-9);
}

TEST(BadStreams, GapsAreCountedAndRoundedStreamByStream) {
  MotionStreams streams = good();
  streams.steering.clear();
  for (int k = 0; k < 1500; ++k) {
    const double t = 0.02 * k;
    if (t > 6.01 && t < 11.27) continue;
    streams.steering.push_back({t, 0.0});
  }
  std::vector<std::string> notes = stream_notes(streams, {});
  ASSERT_EQ(notes.size(), 1U);
  expect_words(notes[0], "1 gap in steering0, of 5.3 s: bridged, not filled");
  std::erase_if(streams.steering, [](const auto& s) { return s.t_s > 2.0 && s.t_s < 3.0; });
  notes = stream_notes(streams, {});
  ASSERT_EQ(notes.size(), 1U);
  expect_words(notes[0], "2 gaps in steering0, the longest 5.3 s");
}

TEST(BadStreams, WhatIsMissingIsSaid) {
  MotionStreams streams = good();
  streams.gyro.clear();
  const Diagnosis d = diagnose(streams, "drive");
  ASSERT_FALSE(d.notes.empty());
  expect_words(d.notes[0], "gyro not diagnosed");
  EXPECT_TRUE(d.causes.empty());
}

// Friction readings at 10 Hz on a circle of 20 m, from a car that is moving or at rest.
struct Friction {
  std::vector<PoseSample> poses;
  std::vector<RawFriction> raw;

  explicit Friction(double speed, std::size_t count = 600) {
    Random random(5);
    for (std::size_t k = 0; k < count; ++k) {
      const double t = 0.1 * static_cast<double>(k), a = speed / 20.0 * t;
      poses.push_back({t, 20.0 * std::sin(a) + 0.01 * random.normal(),
                       20.0 - 20.0 * std::cos(a) + 0.01 * random.normal(), a});
      raw.push_back({t, 0.8 + 0.05 * random.normal(), 0.05, 1, 20.0});
    }
  }
  [[nodiscard]] std::string said() const {
    DriveReadings readings;
    readings.friction = friction_readings(poses, raw);
    const Diagnosis d = diagnose_readings(readings);
    EXPECT_TRUE(d.causes.empty());
    EXPECT_TRUE(d.unknown.empty());
    std::string all;
    for (const std::string& note : d.notes) all += note + "; ";
    for (const std::string& name : d.not_observable) all += name + " not observable; ";
    return all;
  }
};

TEST(BadReadings, TooFewAreSaidToBeSo) {
  expect_words(Friction(3.0, 60).said(), "60 readings with a reference pose, want at least 100");
}

TEST(BadReadings, ACarThatStandsShowsNothingOfFriction) {
  expect_words(Friction(0.0).said(), "friction0 not diagnosed: the car drove");
}

TEST(BadReadings, WhereReferencePosesHaveAGapReadingsAreCountedAndLeftOut) {
  Friction f(3.0);
  std::erase_if(f.poses, [](const PoseSample& p) { return p.t_s > 20.0 && p.t_s < 30.0; });
  expect_words(f.said(), "of 600 readings left out: no reference pose at their time");
}

TEST(BadReadings, CovariatesThatDoNotVaryAreSaid) {
  const std::string said = Friction(3.0).said();
  expect_words(said, "temperature varies by less than 1 K");
  expect_words(said, "friction0.speed_bias not observable");
  expect_words(said, "friction0.slip_bias not observable");
}

TEST(BadReadings, RangesBeyondTheGreatestOneContradictTheCalibration) {
  std::vector<RangeBeam> beams(10);
  for (RangeBeam& b : beams) b.range_m = 25.0;
  const RangeReadings readings = expect_ranges(beams, 20.0);
  ASSERT_FALSE(readings.notes.empty());
  expect_words(readings.notes.front(),
               "contradictory calibration: range0 reads up to 25 m; 10 readings exceed");
}

TEST(Contradictions, NameTheDimensionAndBothValues) {
  WheelModel drive;
  WheelModel map = drive;
  map.wheelbase_m = 2.8;
  map.radius_left_m *= 1.005;  // tyres differ so
  const auto lines = contradictions(map, "in the map", drive, "in the drive");
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0],
            "contradictory calibration: wheelbase is 2.8 m in the map and 2.6 m in the drive");
}

}  // namespace
}  // namespace roadbook
