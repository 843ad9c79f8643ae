#include "diagnosis/streams/stream_faults.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/random.hpp"
#include "diagnosis/diagnose.hpp"
#include "tests/diagnosis/hidden_effects/recorded_streams.hpp"
#include "tests/support/expect_words.hpp"

// Faults of a recording must not be named as effects of sensors.

namespace roadbook {
namespace {

using test::expect_words;

MotionStreams recorded_m(double length_m) {
  test::HiddenDriveOptions options;
  options.length_m = length_m;
  return test::streams_of(test::record_drive(options));
}

template <typename Sample>
void later_by(std::vector<Sample>& stream, double by_s) {
  for (Sample& s : stream) s.t_s += by_s;
}

std::string stamps_refused(const MotionStreams& streams) {
  try {
    static_cast<void>(diagnose(streams, "drive"));
  } catch (const BadInput& error) {
    return error.what();
  }
  return "accepted";
}

// No effect is named; the first note reports the fault.
void expect_fault(const MotionStreams& streams, const std::string& words) {
  const Diagnosis d = diagnose(streams, "drive");
  for (const FoundCause& c : d.causes) ADD_FAILURE() << c.effect << " " << c.size;
  for (const UnknownCause& u : d.unknown) ADD_FAILURE() << u.hook << " ~ " << u.depends_on;
  ASSERT_FALSE(d.notes.empty());
  expect_words(d.notes.front(), words);
}

TEST(StreamFaults, ClocksAnHourApartAreRefusedWithBothSpans) {
  MotionStreams streams = recorded_m(60.0);
  later_by(streams.gyro, 3600.0);
  const std::string said = stamps_refused(streams);
  expect_words(said, "drive: imu0 stamps: got 3600 to ");
  expect_words(said, "in common with the poses (0 to ");
  streams = recorded_m(60.0);
  later_by(streams.wheels, -3600.0);
  later_by(streams.steering, -3600.0);
  expect_words(stamps_refused(streams), "wheels0 stamps: got -3600 to ");
}

TEST(StreamFaults, ClocksFartherApartThanALatencyIsSearchedForAreRefused) {
  for (const double by : {-12.0, 12.0}) {
    MotionStreams streams = recorded_m(200.0);
    later_by(streams.gyro, by);
    const std::string said = stamps_refused(streams);
    expect_words(said, "imu0 stamps: got readings ");
    expect_words(said, by > 0.0 ? " s behind the motion" : " s ahead of the motion");
    streams = recorded_m(200.0);
    later_by(streams.wheels, by);
    expect_words(stamps_refused(streams), "wheels0 stamps: got readings ");
  }
}

TEST(StreamFaults, AWrongUnitOfTimeIsSaid) {
  MotionStreams streams = recorded_m(60.0);
  for (GyroSample& s : streams.gyro) s.t_s *= 1000.0;
  const std::string said = stamps_refused(streams);
  expect_words(said, "imu0 stamps: got a reading every 10 s, want every");
  expect_words(said, "check the unit of the stamps");
  streams = recorded_m(60.0);
  for (PoseSample& s : streams.poses) s.t_s *= 1000.0;
  expect_words(stamps_refused(streams), "poses stamps: got a reading every ");
}

TEST(StreamFaults, AnEncoderThatNeverTurnsIsNoEffect) {
  MotionStreams streams = recorded_m(60.0);
  for (WheelSample& w : streams.wheels) w.left_rad = 3.0;
  expect_fault(streams, "data fault: wheels0 (left) stands still from 0.0 to ");
  for (WheelSample& w : streams.wheels) w.right_rad = w.left_rad;
  expect_fault(streams, "wheels0 is left out");
}

TEST(StreamFaults, AnEncoderThatSticksForAWhileIsNoEffect) {
  MotionStreams streams = recorded_m(200.0);
  const double from = 0.4 * streams.wheels.back().t_s;
  double held = 0.0;
  for (WheelSample& w : streams.wheels) {
    if (w.t_s < from)
      held = w.right_rad;
    else if (w.t_s < from + 8.0)
      w.right_rad = held;
  }
  expect_fault(streams, "data fault: wheels0 (right) stands still from ");
}

TEST(StreamFaults, AloneBesideThePosesAStuckEncoderIsRefused) {
  MotionStreams streams = recorded_m(60.0);
  for (WheelSample& w : streams.wheels) w.left_rad = w.right_rad = 0.0;
  streams.gyro.clear();
  streams.steering.clear();
  expect_words(stamps_refused(streams), "streams: got data fault: wheels0");
}

TEST(StreamFaults, ASensorThatNeverChangesWhileTheCarTurnsIsNoEffect) {
  MotionStreams streams = recorded_m(200.0);
  for (GyroSample& s : streams.gyro) s.rate_rad_s = 0.001;
  expect_fault(streams, "data fault: imu0 reads 0.001 rad/s at all times");
  streams = recorded_m(200.0);
  for (SteeringSample& s : streams.steering) s.angle_rad = 0.0;
  expect_fault(streams, "data fault: steering0 reads 0 rad at all times");
}

// A circle with constant steering, and a stop during which the receiver drifts and jumps.
TEST(StreamFaults, WhatTrulyStandsStillIsNoFault) {
  MotionStreams streams;
  Random random(7);
  double angle = 0.0, wander = 0.0;
  for (int k = 0; k < 1500; ++k) {
    const double t = 0.04 * k;
    const bool stop = t > 20.0 && t < 40.0;
    if (!stop) angle += 0.04 * 0.2;
    if (stop) wander += 0.02 * random.normal() + (k == 700 ? 4.0 : 0.0);
    streams.poses.push_back({t, 15.0 * std::sin(angle) + wander, 15.0 - 15.0 * std::cos(angle),
                             std::remainder(angle, 6.283185307179586)});
    streams.wheels.push_back({t, 15.0 * angle / 0.3, 15.0 * angle / 0.3});
    streams.steering.push_back({t, 0.17});
  }
  EXPECT_TRUE(drop_stuck(streams).empty());
  EXPECT_EQ(streams.wheels.size(), 1500U);
  EXPECT_EQ(streams.steering.size(), 1500U);
}

}  // namespace
}  // namespace roadbook
