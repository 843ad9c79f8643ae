#include "diagnosis/logs/plain_columns.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/diagnosis/plain_log_files.hpp"

// Faults of `covariates` in a plain log are reported in one line each.

namespace roadbook {
namespace {

class PlainColumns : public test::PlainLogFolder {
 protected:
  PlainColumns() {
    write("p.csv", "t,x,y,h\n10,0,0,0\n11,1,0,0\n");
    write("c.csv", "t,w,volts\n10,0,12.5\n10.5,0,12.75\n");
  }
  [[nodiscard]] std::string fault(const std::vector<std::string>& covariates,
                                  const std::string& more = {}) const {
    std::string yaml = kBase + "covariates:\n";
    for (const std::string& one : covariates) yaml += "  - " + one + "\n";
    return refusal(yaml + more);
  }
  // The faults of the covariate in the fifth line of the description.
  [[nodiscard]] std::string of_field(const std::string& field, const std::string& one) const {
    const std::string all = fault({one});
    const std::string begin = "error: log.yaml:5: covariates[0]." + field + ": ";
    EXPECT_EQ(all.substr(0, begin.size()), begin) << all;
    EXPECT_EQ(all.find('\n'), all.size() - 1) << all;
    return all.substr(std::min(begin.size(), all.size()), all.size() - begin.size() - 1);
  }
  // A car that drives 20 m in 20 s along a straight line and measures friction.
  void write_friction_drive() const {
    std::string poses = "t,x,y,h\n";
    std::string friction = "t,mu,temp,volts,flat\n";
    for (int i = 0; i <= 200; ++i) {
      const double t = 100.0 + 0.1 * i;
      poses += std::to_string(t) + "," + std::to_string(0.1 * i) + ",0,0\n";
      friction += std::to_string(t) + ",0.8," + std::to_string(20.0 + 0.01 * i) + "," +
                  std::to_string(std::sin(0.1 * i)) + ",12.6\n";
    }
    write("drive.csv", poses);
    write("f.csv", friction);
  }
  const std::string kVehicleLine =
      "vehicle: {radius_m: 0.5, track_width_m: 1.5, wheelbase_m: 2.5}\n";
  const std::string kBase = kVehicleLine +
                            "poses: {file: p.csv, time: t, x: x, y: y, heading: h}\n"
                            "gyro: {file: c.csv, time: t, rate: w}\n";
  const std::string kFrictionDrive =
      kVehicleLine + "poses: {file: drive.csv, time: t, x: x, y: y, heading: h}\n";
  const std::string kFriction = "friction: {file: f.csv, time: t, value: mu}\n";
};

TEST_F(PlainColumns, AreReadByTheirNames) {
  const PlainLog log = read(kBase +
                            "covariates:\n"
                            "  - {name: battery, file: c.csv, time: t, column: volts, unit: V}\n"
                            "  - {name: w, file: c.csv, time: t, scale: 1000, offset: 5}\n");
  const auto& columns = log.streams.columns;
  ASSERT_EQ(columns.size(), 2U);
  EXPECT_EQ(columns[0].name, "battery");
  EXPECT_EQ(columns[0].unit, "V");
  EXPECT_EQ(columns[0].t_s, (std::vector<double>{0.0, 0.5}));  // the first pose is at 0
  EXPECT_EQ(columns[0].values, (std::vector<double>{12.5, 12.75}));
  EXPECT_EQ(columns[1].unit, "");  // a number, where none is given
  EXPECT_EQ(columns[1].values, (std::vector<double>{5.0, 5.0}));
}

TEST_F(PlainColumns, ThatAreNotThereAreNamedWithThoseThatAre) {
  EXPECT_EQ(fault({"{name: battery, file: c.csv, time: t, column: amps}"}),
            "error: c.csv:1: covariates.battery.column: got amps, want one of t, w, volts, or a "
            "number from 1\n");
  EXPECT_EQ(fault({"{name: battery, file: c.csv, time: t}"}),
            "error: c.csv:1: covariates.battery.column: got battery, want one of t, w, volts, or "
            "a number from 1\n");
  EXPECT_EQ(fault({"{name: battery, file: c.csv, time: t, column: 4}"}),
            "error: c.csv:1: covariates.battery.column: got 4, want a column from 1 to 3\n");
  EXPECT_EQ(fault({"{name: battery, file: c.csv, time: ms, column: volts}"}),
            "error: c.csv:1: covariates.battery.time: got ms, want one of t, w, volts, or a number "
            "from 1\n");
  EXPECT_EQ(fault({"{name: battery, file: none.csv, time: t, column: volts}"}),
            "error: none.csv: got a file that cannot be read, want a text table\n");
}

// The first faulty row and the number of all; every row of a gear in letters is faulty.
TEST_F(PlainColumns, WithoutNumbersAreNamedWithTheirFirstRow) {
  const auto of = [&](const std::string& rows) {
    write("g.csv", "t,gear\n" + rows);
    return fault({"{name: gear, file: g.csv, time: t}"});
  };
  EXPECT_EQ(of("10,1\n11,nan\n12,2\n"),
            "error: g.csv:3: covariates.gear.column: got 'nan', want a finite number\n");
  EXPECT_EQ(of("10,P\n11,R\n12,D\n"),
            "error: g.csv:2: covariates.gear.column: got 'P' and 2 more such rows, want a finite "
            "number\n");
  EXPECT_EQ(
      of("10,1\n11,\n12,inf\n"),
      "error: g.csv:3: covariates.gear.column: got nothing and 1 more such rows, want a finite "
      "number\n");
  EXPECT_EQ(of("10,1\n11\n12,2\n"),
            "error: g.csv:3: covariates.gear.column: got 1 fields, want at least 2 fields\n");
  EXPECT_EQ(of("10,1\n9,2\n8,3\n"),
            "error: g.csv:3: covariates.gear.time: got 9.000000 s after 10.000000 s and 1 more "
            "such rows, want increasing stamps\n");
  EXPECT_EQ(of(""), "error: g.csv: rows: got none, want at least one row of numbers\n");
}

TEST_F(PlainColumns, GivenTwiceAreRefused) {
  EXPECT_EQ(fault({"{name: battery, file: c.csv, time: t, column: volts}",
                   "{name: battery, file: c.csv, time: t, column: w}"}),
            "error: log.yaml:6: covariates[1].name: got battery, want another name: this one is "
            "another covariate's\n");
  EXPECT_EQ(fault({"{name: battery, file: c.csv, time: t, column: volts}",
                   "{name: supply, file: c.csv, time: t, column: volts, scale: 2}"}),
            "error: log.yaml:6: covariates[1].column: got volts, want a column that is not listed "
            "as battery "
            "already\n");
}

TEST_F(PlainColumns, WithANameThatMeansSomethingElseAreRefused) {
  for (const std::string name : {"speed", "yaw rate", "time", "left wheel phase", "curvature"})
    EXPECT_EQ(of_field("name", "{name: " + name + ", file: c.csv, time: t, column: volts}"),
              "got " + name + ", want another name: this one is diagnosis' own");
  EXPECT_EQ(of_field("name", "{name: wheels0.radius, file: c.csv, time: t, column: volts}"),
            "got wheels0.radius, want another name: this one is an effect's");
  write_friction_drive();
  const auto with = [&](const std::string& friction, const std::string& name) {
    return refusal(kFrictionDrive + friction + "covariates:\n  - {name: " + name +
                   ", file: f.csv, time: t, column: volts}\n");
  };
  const std::string warm = "friction: {file: f.csv, time: t, value: mu, temperature_c: temp}\n";
  EXPECT_EQ(with(kFriction, "friction in use"),
            "error: log.yaml:5: covariates[0].name: got friction in use, want another name: this "
            "one is diagnosis' own\n");
  EXPECT_EQ(with(warm, "temperature"),
            "error: log.yaml:5: covariates[0].name: got temperature, want another name: this one "
            "is diagnosis' own\n");
  // Without a temperature column in friction the name is free.
  EXPECT_EQ(with(kFriction, "temperature"), "accepted");
  EXPECT_EQ(fault({"{name: friction in use, file: c.csv, time: t, column: volts}"}), "accepted");
}

TEST_F(PlainColumns, ThatAreDescribedWronglyAreRefused) {
  const std::string rest = "file: c.csv, time: t, column: volts";
  EXPECT_EQ(of_field("name", "{" + rest + "}"), "got nothing, want this key");
  EXPECT_EQ(of_field("name", "{name: , " + rest + "}"), "got nothing, want a word");
  EXPECT_EQ(of_field("name", "{name: '', " + rest + "}"),
            "got nothing, want the name of the column, in one line");
  EXPECT_EQ(of_field("name", "{name: \"a\\nb\", " + rest + "}"),
            "got a?b, want the name of the column, in one line");
  EXPECT_EQ(of_field("unit", "{name: battery, unit: , " + rest + "}"), "got nothing, want a word");
  EXPECT_EQ(of_field("units", "{name: battery, units: V, " + rest + "}"),
            "got an unknown key, want a known one (did you mean unit?)");
  EXPECT_EQ(of_field("scale", "{name: battery, scale: 0, " + rest + "}"), "got 0, want not zero");
  EXPECT_EQ(of_field("column", "{name: battery, file: c.csv, time: t, column: }"),
            "got nothing, want a word");
  EXPECT_EQ(of_field("file", "{name: volts, time: t}"), "got nothing, want the table's file");
  EXPECT_EQ(of_field("time", "{name: volts, file: c.csv}"),
            "got nothing, want column, unit and offset of the stamps");
  EXPECT_EQ(of_field("time.unit", "{name: volts, file: c.csv, time: {column: t, unit: min}}"),
            "got min, want one of s, ms, us, ns");
  EXPECT_EQ(refusal(kBase + "covariates: {name: volts, file: c.csv, time: t}\n"),
            "error: log.yaml:4: covariates: got a mapping, want a list of mappings\n");
  EXPECT_EQ(fault({"volts"}), "error: log.yaml:5: covariates[0]: got volts, want a mapping\n");
}

// If motion is recorded, it reports unusable columns; a log of friction alone reports them itself.
TEST_F(PlainColumns, OfALogOfFrictionThatCannotBeUsedAreSaid) {
  write_friction_drive();
  const PlainLog log = read(kFrictionDrive + kFriction +
                            "covariates:\n"
                            "  - {name: battery, file: f.csv, time: t, column: volts}\n"
                            "  - {name: flat, file: f.csv, time: t}\n"
                            "  - {name: late, file: f.csv, time: {column: t, offset: 3600}, "
                            "column: temp}\n");
  ASSERT_EQ(log.readings.friction.columns.size(), 1U);
  EXPECT_EQ(log.readings.friction.columns[0].name(), "battery");
  EXPECT_EQ(
      log.notes,
      (std::vector<std::string>{
          "flat does not vary (12.6 throughout): effects that depend on it are not observable",
          "late has 0 readings in this drive, fewer than 10 (its stamps: 3600 to 3620 s, the "
          "drive: 0 to 20 s): effects that depend on it are not observable"}));
  const PlainLog nobody =
      read(kFrictionDrive + "covariates:\n  - {name: volts, file: f.csv, time: t}\n");
  EXPECT_EQ(nobody.notes,
            std::vector<std::string>{
                "covariates: not used, because this log records neither motion nor friction"});
}

}  // namespace
}  // namespace roadbook
