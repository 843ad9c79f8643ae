#include "diagnosis/logs/plain_log.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <string>

#include "base/digest.hpp"
#include "diagnosis/logs/local_enu.hpp"
#include "tests/diagnosis/plain_log_files.hpp"
#include "tests/support/expect_words.hpp"
#include "tests/support/real_data.hpp"

namespace roadbook {
namespace {

using test::expect_words;

constexpr double kDegree = std::numbers::pi / 180.0;

class PlainLogFiles : public test::PlainLogFolder {};

const std::string kVehicle = "vehicle: {radius_m: 0.5, track_width_m: 1.5, wheelbase_m: 2.5, ";
const std::string kPoses =
    "poses: {file: p.csv, time: t, x: x, y: y, heading: {column: h, unit: deg}}\n";

TEST_F(PlainLogFiles, UnitsSignsAndRatiosBecomeRadiansAndSeconds) {
  write("p.csv", "t,x,y,h\n10,0,0,90\n11,0,5,90\n");
  write("s.csv", "# ms;left km/h;right;wheel;gyro\n10000;18;36;30;3\n12000;36;36;60;-3\n");
  const PlainLog log = read(kVehicle + "steering_ratio: 15}\n" + kPoses +
                            "wheels: {file: s.csv, separator: ';', time: {column: ms, unit: ms},\n"
                            "  left: {column: left km/h, unit: km/h},\n"
                            "  right: {column: 3, unit: km/h}}\n"
                            "steering: {file: s.csv, separator: ';', time: {column: ms, unit: ms, "
                            "offset: 0.25}, angle: {column: wheel, unit: deg}}\n"
                            "gyro: {file: s.csv, separator: ';', time: {column: ms, unit: ms}, "
                            "rate: {column: gyro, unit: deg/s, sign: -1}}\n");
  const MotionStreams& s = log.streams;
  EXPECT_NEAR(s.poses[0].heading, std::numbers::pi / 2, 1e-12);
  EXPECT_NEAR(s.poses[1].t_s, 1.0, 1e-12);
  // 5 to 10 m/s in 2 s are 15 m, 10 m/s are 20 m, on a radius of 0.5 m.
  EXPECT_NEAR(s.wheels[1].left_rad, 30.0, 1e-12);
  EXPECT_NEAR(s.wheels[1].right_rad, 40.0, 1e-12);
  EXPECT_NEAR(s.steering[0].t_s, 0.25, 1e-12);
  EXPECT_NEAR(s.steering[1].angle_rad, 4.0 * kDegree, 1e-12);
  EXPECT_NEAR(s.gyro[0].rate_rad_s, -3.0 * kDegree, 1e-12);
}

TEST_F(PlainLogFiles, TheDigestIsOfTheFilesAsWellAndOfEachOnce) {
  const std::string yaml = kVehicle + "}\n" + kPoses +
                           "gyro: {file: g.csv, time: t, rate: w}\n"
                           "steering: {file: g.csv, time: t, angle: w}\n";
  const auto digest = [&](const std::string& last_rate) {
    write("p.csv", "t,x,y,h\n0,0,0,0\n1,1,0,0\n");
    write("g.csv", "t,w\n0,0\n1," + last_rate + "\n");
    return read(yaml).digest;
  };
  const std::string one = digest("0.5");
  EXPECT_NE(digest("0.6"), one);
  EXPECT_EQ(digest("0.5"), one);
  EXPECT_EQ(one, sha256_hex(yaml + "t,x,y,h\n0,0,0,0\n1,1,0,0\n" + "t,w\n0,0\n1,0.5\n"));
}

TEST_F(PlainLogFiles, ACounterThatBeginsAgainGoesOn) {
  write("p.csv", "t,x,y,h\n0,0,0,0\n1,1,0,0\n");
  write("w.txt", "a 0 250  2\n b  1  4 254\n");
  const PlainLog log =
      read(kVehicle + "}\n" + kPoses +
           "wheels: {file: w.txt, separator: whitespace, header: false, time: 2,\n"
           "  left: {column: 3, unit: ticks, ticks_per_turn: 20, wraps_at: 256},\n"
           "  right: {column: 4, unit: ticks, ticks_per_turn: 20, wraps_at: 256}}\n");
  const auto& w = log.streams.wheels;
  EXPECT_NEAR(w[1].left_rad - w[0].left_rad, std::numbers::pi, 1e-12);           // ten ticks on
  EXPECT_NEAR(w[1].right_rad - w[0].right_rad, -0.4 * std::numbers::pi, 1e-12);  // four back
}

// Ten and four ticks of twenty a turn since the last row; a wheelbase is not asked for without
// steering.
TEST_F(PlainLogFiles, CountsOfEachRowAddUpAndNeedNoWheelbase) {
  write("p.csv", "t,x,y,h\n0,0,0,0\n1,1,0,0\n");
  write("w.csv", "t,l,r,d\n0,3,3,9\n1,10,-4,90\n2,5,2,180\n");
  const std::string vehicle = "vehicle: {radius_m: 0.5, track_width_m: 1.5}\n";
  const std::string ticks = "unit: ticks/row, ticks_per_turn: 20}";
  const PlainLog log = read(vehicle + kPoses + "wheels: {file: w.csv, time: t, left: {column: l, " +
                            ticks + ", right: {column: r, " + ticks + "}\n");
  const auto& w = log.streams.wheels;
  ASSERT_EQ(w.size(), 3U);
  EXPECT_NEAR(w[1].left_rad - w[0].left_rad, std::numbers::pi, 1e-12);
  EXPECT_NEAR(w[1].right_rad - w[0].right_rad, -0.4 * std::numbers::pi, 1e-12);
  EXPECT_NEAR(w[2].left_rad - w[0].left_rad, 1.5 * std::numbers::pi, 1e-12);
  const PlainLog degrees = read(vehicle + kPoses +
                                "wheels: {file: w.csv, time: t, left: {column: d, unit: deg/row},\n"
                                "  right: {column: d, unit: deg/row}}\n");
  EXPECT_NEAR(degrees.streams.wheels[2].left_rad - degrees.streams.wheels[0].left_rad,
              1.5 * std::numbers::pi, 1e-12);
  expect_words(refusal(vehicle + kPoses +
                       "wheels: {file: w.csv, time: t, left: {column: l, unit: ticks/row}, "
                       "right: r}\n"),
               "ticks_per_turn: got nothing");
  expect_words(refusal(vehicle + kPoses + "steering: {file: w.csv, time: t, angle: l}\n"),
               "vehicle.wheelbase_m: got nothing");
}

TEST_F(PlainLogFiles, PositionsWithoutADirectionGetTheCourseAsAFirstGuess) {
  write("p.csv", "t,x,y,h\n0,0,0,0\n1,1,1,0\n2,2,2,0\n3,2,2,0\n");
  write("g.csv", "t,w\n0,0\n1,0\n");
  const PlainLog log = read(kVehicle +
                            "}\nposes: {file: p.csv, time: t, x: x, y: y}\n"
                            "gyro: {file: g.csv, time: t, rate: w}\n");
  for (const PoseSample& p : log.streams.poses) EXPECT_NEAR(p.heading, std::numbers::pi / 4, 1e-12);
  EXPECT_FALSE(log.streams.poses_have_heading);
  ASSERT_FALSE(log.notes.empty());
  expect_words(log.notes.front(), "no heading");
}

// Bit for bit: knots fall on readings or beside them by the last digits of times.
TEST_F(PlainLogFiles, WhatIsAddedToAllStampsLeavesNoTrace) {
  std::string poses = "t,x,y\n";
  std::string rows = "t,v,w\n";
  for (int k = 0; k <= 400; ++k) {
    const double t = 0.025 * k;
    rows += std::to_string(t) + "," + std::to_string(2.0 + std::sin(t)) + ",0.1\n";
    if (k % 8 == 0) poses += std::to_string(t) + "," + std::to_string(2.0 * t) + ",0\n";
  }
  write("p.csv", poses);
  write("v.csv", rows);
  std::string ranges = "t,id,r\n";
  for (int k = 0; k < 60; ++k) ranges += std::to_string(1.013 + 0.1 * k) + ",7,4.5\n";
  write("b.csv", ranges);
  write("places.csv", "id,x,y\n7,5,2\n");
  const auto log = [&](const std::string& offset) {
    const std::string time = "time: {column: t, offset: " + offset + "}";
    return read(kVehicle + "}\nposes: {file: p.csv, " + time + ", x: x, y: y}\n" +
                "speed: {file: v.csv, " + time + ", value: {column: v, unit: m/s}}\n" +
                "gyro: {file: v.csv, " + time + ", rate: w}\n" + "beacons: {file: b.csv, " + time +
                ", id: id, range: r, places: {file: places.csv, id: id, x: x, y: y}}\n");
  };
  const PlainLog unshifted = log("0");
  const MotionStreams& expected = unshifted.streams;
  const auto& beacons = unshifted.readings.beacons.samples;
  ASSERT_EQ(beacons.size(), 60U);
  EXPECT_EQ(expected.gyro[3].t_s, 0.075);
  // Finer than a microsecond: still in order.
  write("u.csv", "t,w\n0,0\n2e-7,0\n4e-7,0\n");
  const MotionStreams fine = read(kVehicle + "}\nposes: {file: p.csv, time: t, x: x, y: y}\n" +
                                  "gyro: {file: u.csv, time: t, rate: w}\n")
                                 .streams;
  ASSERT_EQ(fine.gyro.size(), 3U);
  EXPECT_LT(fine.gyro[1].t_s, fine.gyro[2].t_s);
  for (const char* offset : {"0.001", "0.013", "0.05", "12345.678", "1000000000"}) {
    SCOPED_TRACE(offset);
    const PlainLog shifted = log(offset);
    const MotionStreams& s = shifted.streams;
    ASSERT_EQ(shifted.readings.beacons.samples.size(), beacons.size());
    for (std::size_t i = 0; i < beacons.size(); ++i) {
      EXPECT_EQ(shifted.readings.beacons.samples[i].t_s, beacons[i].t_s);
      EXPECT_EQ(shifted.readings.beacons.samples[i].expected_m, beacons[i].expected_m);
    }
    ASSERT_EQ(s.poses.size(), expected.poses.size());
    ASSERT_EQ(s.wheels.size(), expected.wheels.size());
    ASSERT_EQ(s.gyro.size(), expected.gyro.size());
    for (std::size_t i = 0; i < s.poses.size(); ++i) {
      EXPECT_EQ(s.poses[i].t_s, expected.poses[i].t_s);
      EXPECT_EQ(s.poses[i].heading, expected.poses[i].heading);
    }
    for (std::size_t i = 0; i < s.wheels.size(); ++i) {
      EXPECT_EQ(s.wheels[i].t_s, expected.wheels[i].t_s);
      EXPECT_EQ(s.wheels[i].left_rad, expected.wheels[i].left_rad);
      EXPECT_EQ(s.gyro[i].t_s, expected.gyro[i].t_s);
    }
  }
}

TEST_F(PlainLogFiles, OneSpeedSaysWhichWheelItIsAndSatellitesHaveNoMap) {
  write("p.csv", "t,x,y,h\n0,0,0,0\n1,1,0,0\n");
  const std::string poses =
      "poses: {file: p.csv, time: t, x: x, y: y, heading: h, measured_by: satellites}\n";
  const std::string speed = "speed: {file: p.csv, time: t, value: {column: x, unit: m/s}, of: ";
  const PlainLog log = read(kVehicle + "}\n" + poses + speed + "left}\n");
  EXPECT_EQ(log.streams.wheels_read, WheelsRead::kLeft);
  EXPECT_EQ(log.without, (std::vector<std::string>{"map.scale", "map.bend"}));
  expect_words(refusal(kVehicle + "}\n" + poses + speed + "boot}\n"),
               "got boot, want middle, front_wheel, left or right");
  expect_words(refusal("vehicle: {radius_m: 0.5, wheelbase_m: 2.5}\n" + poses + speed + "left}\n"),
               "vehicle.track_width_m: got nothing");
}

// A degree of the meridian through its radius of curvature, a degree of a parallel by its circle.
TEST(LocalEnu, SmallStepsFollowTheRadiiOfCurvature) {
  const double a = 6378137.0, f = 1.0 / 298.257223563, e2 = f * (2 - f);
  const Geodetic o{47.0 * kDegree, 8.0 * kDegree, 400.0};
  const double w2 = 1 - e2 * std::pow(std::sin(o.latitude_rad), 2);
  const double M = a * (1 - e2) / std::pow(w2, 1.5), N = a / std::sqrt(w2);
  const double step = 1e-5;  // about 64 m; curvature bends it by step^2 N / 2 = 0.3 mm
  const auto north = local_enu({o.latitude_rad + step, o.longitude_rad, 400.0}, o);
  const auto east = local_enu({o.latitude_rad, o.longitude_rad + step, 400.0}, o);
  EXPECT_NEAR(north.y(), (M + 400.0) * step, 1e-4);
  EXPECT_NEAR(north.x(), 0.0, 1e-9);
  EXPECT_NEAR(east.x(), (N + 400.0) * std::cos(o.latitude_rad) * step, 1e-4);
  EXPECT_NEAR(local_enu({o.latitude_rad, o.longitude_rad, 403.0}, o).z(), 3.0, 1e-8);
}

TEST_F(PlainLogFiles, FaultsNameFileLineAndField) {
  write("p.csv", "t,x,y,h\n0,0,0,0\n1,abc,0,0\n1,2,0,0\n");
  write("g.csv", "t,w\n0,0\n");
  const std::string gyro = "gyro: {file: g.csv, time: t, rate: w}\n";
  const std::string bad = refusal(kVehicle + "}\n" + kPoses + gyro);
  expect_words(bad, "p.csv:3: poses.x: got 'abc', want a finite number");
  expect_words(bad, "p.csv:4: poses.time: got 1.000000 s after 1.000000 s");
  write("p.csv", "t,x,y,h\n0,0,0,0\n1,1,0,0\n");
  expect_words(refusal(kVehicle + "}\n" + kPoses + "gyro: {file: g.csv, time: t, rate: rate}\n"),
               "g.csv:1: gyro.rate: got rate, want one of t, w");
  expect_words(refusal(kVehicle + "}\n" + kPoses + "gyro: {file: none.csv, time: t, rate: w}\n"),
               "none.csv: got a file that cannot be read");
  const std::string unit = refusal(kVehicle + "}\n" + kPoses +
                                   "gyro: {file: g.csv, time: t, rate: {column: w, unit: km/h}}\n");
  const std::string of_unit = "got km/h, want one of rad/s, deg/s";
  expect_words(unit, of_unit);
  EXPECT_EQ(unit.find(of_unit), unit.rfind(of_unit)) << "said once";
  expect_words(refusal(gyro), "poses: got nothing");
}

TEST_F(PlainLogFiles, AWrongUnitOfTimeThatLeavesNoPoseIsSaid) {
  write("p.csv", "t,x,y,h\n0,0,0,0\n1,5,0,0\n2,10,0,0\n");
  expect_words(
      refusal(kVehicle +
              "}\nposes: {file: p.csv, time: {column: t, unit: ms}, x: x, y: y, heading: h, "
              "drop_jumps_m_s: 12}\n"),
      "poses.drop_jumps_m_s: got 12.000000 m/s, which leaves one pose of 3, want a speed "
      "that the car reaches (check the units of time and positions)");
}

TEST_F(PlainLogFiles, RepeatedStampsAreDroppedWhereTheDescriptionSaysSoAtTheTopOrInTheStream) {
  write("p.csv", "t,x,y,h\n0,0,0,0\n0,9,9,9\n1,1,0,0\n");
  write("g.csv", "t,w\n0,0\n0.5,1\n0.5,2\n1,3\n");
  const std::string gyro = "gyro: {file: g.csv, time: t, rate: w";
  const std::string yaml = kVehicle + "}\n" + kPoses + gyro;
  const std::string advice = refusal(yaml + "}\n");
  expect_words(advice,
               "p.csv:3: poses.time: got 0.000000 s after 0.000000 s, want increasing stamps "
               "(drop_repeats: true, in poses or at the top for all streams, drops equal ones)");
  // Follows the advice: at the top level, and in each stream.
  const PlainLog log = read("drop_repeats: true\n" + yaml + "}\n");
  ASSERT_EQ(log.streams.poses.size(), 2u);
  EXPECT_EQ(log.streams.poses[1].x, 1.0);
  EXPECT_EQ(log.streams.gyro.size(), 3u);
  expect_words(log.notes.at(0), "poses: 1 of 3 rows with a repeated stamp dropped");
  std::string poses = kPoses;
  poses.replace(poses.find("time: t"), 7, "time: t, drop_repeats: true");
  const auto only_poses = refusal(kVehicle + "}\n" + poses + gyro + "}\n");
  EXPECT_EQ(only_poses.find("p.csv"), std::string::npos) << only_poses;
  expect_words(only_poses, "g.csv:4: gyro.time");
  EXPECT_EQ(read(kVehicle + "}\n" + poses + gyro + ", drop_repeats: true}\n").streams.gyro.size(),
            3u);
  // The value of a stream takes precedence.
  expect_words(refusal("drop_repeats: true\n" + yaml + ", drop_repeats: false}\n"), "gyro.time");
}

TEST_F(PlainLogFiles, KeysOfAStreamAtTheTopSayWhereTheyBelong) {
  write("p.csv", "t,x,y,h\n0,0,0,0\n1,1,0,0\n");
  const std::string yaml = kVehicle + "}\n" + kPoses;
  const auto said = refusal("drop_jumps_m_s: 30\nwraps_at: 256\n" + yaml);
  expect_words(said, "drop_jumps_m_s: got this key at the top level, want it within poses");
  expect_words(said, "wraps_at: got this key at the top level, want it within a column's mapping");
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 2) << said;
}

TEST_F(PlainLogFiles, OtherSeparatorsQuotesAndEncodingsAreNamed) {
  const std::string yaml = kVehicle + "}\n" + kPoses;
  write("p.csv", "t;x;y;h\n0;0;0;0\n1;1;0;0\n");
  expect_words(refusal(yaml),
               "p.csv:1: poses.time: got t (semicolons between them, but the "
               "description states separator: \",\"), want one of t;x;y;h");
  write("p.csv", "t,x,y,h\n0;0;0;0\n1;1;0;0\n");
  expect_words(refusal(yaml), "p.csv:2: poses.time: got '0;0;0;0' (semicolons between them");
  std::string semicolons = kPoses;
  semicolons.replace(semicolons.find("time: t"), 7, "separator: ';', time: t");
  write("p.csv", "t;x;y;h\n0;0;0;0\n1;1,5;0;0\n");
  expect_words(refusal(kVehicle + "}\n" + semicolons),
               "p.csv:3: poses.x: got '1,5', want a finite number with a point, not a comma");
  write("p.csv", std::string("\xFF\xFEt\0,\0", 6));
  expect_words(refusal(yaml), "p.csv:1: got UTF-16 text, want UTF-8 text");
}

TEST_F(PlainLogFiles, ValuesThatNoVehicleHasAreNoted) {
  write("p.csv", "t,x,y,h\n0,0,0,0\n1,1,0,0\n");
  write("s.csv", "t,a,w\n0,1,0\n1,-32.5,20\n");
  const std::string streams =
      "steering: {file: s.csv, time: t, angle: a}\n"
      "gyro: {file: s.csv, time: t, rate: w}\n";
  const PlainLog log = read(kVehicle + "}\n" + kPoses + streams);
  ASSERT_EQ(log.notes.size(), 2u);
  EXPECT_EQ(log.notes[0],
            "steering.angle: up to 32.5 rad (degrees?), where vehicles have at most 1.6");
  EXPECT_EQ(log.notes[1], "gyro.rate: up to 20 rad/s (degrees?), where vehicles have at most 10");
  const PlainLog ratio = read(kVehicle + "steering_ratio: 40}\n" + kPoses +
                              "steering: {file: s.csv, time: t, angle: a}\n");
  EXPECT_TRUE(ratio.notes.empty());
}

TEST(PlainLogOfMeasuredData, TheCarsOwnSpeedsAgreeWithItsPath) {
  ROADBOOK_REQUIRE_DATA(data, "comma2k19_example");
  // The example of the documentation with the local data.
  std::ifstream example(std::filesystem::path(ROADBOOK_SOURCE_DIR) /
                        "docs/examples/logs/comma2k19.yaml");
  const auto yaml = std::filesystem::path(::testing::TempDir()) / "comma2k19.yaml";
  std::ofstream out(yaml);
  for (std::string line; std::getline(example, line);)
    out << (line.starts_with("folder:") ? "folder: " + std::filesystem::absolute(data).string()
                                        : line)
        << '\n';
  out.close();
  const MotionStreams s = read_plain_log(yaml).streams;
  double path = 0.0;
  for (std::size_t i = 1; i < s.poses.size(); ++i)
    path += std::hypot(s.poses[i].x - s.poses[i - 1].x, s.poses[i].y - s.poses[i - 1].y);
  const double rolled = 0.5 * s.wheel_model.radius_left_m *
                        (s.wheels.back().left_rad - s.wheels.front().left_rad +
                         s.wheels.back().right_rad - s.wheels.front().right_rad);
  EXPECT_NEAR(rolled / path, 1.0, 0.02);  // tyres wear and load by as much
}

}  // namespace
}  // namespace roadbook
