#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

#include "base/random.hpp"
#include "diagnosis/diagnose.hpp"
#include "diagnosis/friction/friction_problem.hpp"
#include "tests/diagnosis/hidden_effects/column_study.hpp"
#include "tests/diagnosis/hidden_effects/recorded_streams.hpp"
#include "tests/diagnosis/hidden_effects/seed_of_today.hpp"
#include "tests/drive/drive_fixture.hpp"

namespace roadbook::test {
namespace {

LoggedColumn sampled(const std::string& name, const std::function<double(double)>& of) {
  LoggedColumn column{name, "", {}, {}};
  for (double t = 0.0; t < 400.0; t += 0.1) {
    column.t_s.push_back(t);
    column.values.push_back(of(t));
  }
  return column;
}

bool says(const std::vector<std::string>& notes, const std::string& words) {
  return std::any_of(notes.begin(), notes.end(), [&](const std::string& note) {
    return note.find(words) != std::string::npos;
  });
}

// At least two of three: of many draws more than nine of ten are right (docs/results/diagnosis.md).
TEST(LoggedColumns, WhatASensorDependsOnIsUnknownWithItsHookAndItsColumn) {
  const std::uint64_t seed = seed_of_today();
  int right = 0;
  for (std::uint64_t i = 0; i < 3; ++i) {
    const TemporaryFolder folder;
    const ColumnOutcome outcome = run_hidden_column(seed, i, folder.path() / "log");
    std::cout << outcome.to_line() << "\n";
    if (!outcome.right()) continue;
    ++right;
    const UnknownCause& u = outcome.found.unknown.front();
    EXPECT_GT(u.gain.total, 0.0);
    EXPECT_LT(u.p, 0.01);
    // The curve grows by the hidden size over one standard deviation of the column.
    ASSERT_GT(u.plot.curve.size(), 1U);
    const double rise = u.plot.curve.back().second - u.plot.curve.front().second;
    EXPECT_GT(rise * outcome.hidden.secret.begin()->second, 0.0);
    // The mean of the effect is found as well, under any of these names.
    for (const char* mean : {"imu0.gyro_scale", "imu0.gyro_bias", "wheels0.radius"})
      EXPECT_FALSE(says(outcome.found.not_observable, mean)) << mean;
  }
  EXPECT_GE(right, 2);
}

TEST(LoggedColumns, WhereNothingDependsOnThemNothingIsNamed) {
  const std::uint64_t seed = seed_of_today();
  for (std::uint64_t i = 0; i < 2; ++i) {
    const TemporaryFolder folder;
    const ColumnOutcome outcome = run_idle_columns(seed, i, folder.path() / "log");
    EXPECT_TRUE(outcome.quiet()) << outcome.to_line();
  }
}

// A column that is a function of the motion replaces neither an effect nor a built-in covariate.
TEST(LoggedColumns, OneThatIsAFunctionOfTimeOrSpeedDoesNotStandForThem) {
  HiddenDriveOptions named;
  named.seed = 91;
  named.secret["wheels0.radius_speed"] = 0.004;
  MotionStreams streams = streams_of(record_drive(named));
  const std::vector<PoseSample>& p = streams.poses;
  LoggedColumn dash{"dashboard_speed", "km/h", {}, {}};
  for (std::size_t i = 1; i + 1 < p.size(); ++i) {
    dash.t_s.push_back(p[i].t_s);
    dash.values.push_back(3.6 * std::hypot(p[i + 1].x - p[i - 1].x, p[i + 1].y - p[i - 1].y) /
                          (p[i + 1].t_s - p[i - 1].t_s));
  }
  streams.columns = {dash, sampled("clock", [](double t) { return 12.0 + t / 60.0; })};
  const Diagnosis by_speed = diagnose(streams, "drive");
  ASSERT_EQ(by_speed.causes.size(), 1U);
  EXPECT_EQ(by_speed.causes[0].effect, "wheels0.radius_speed");
  EXPECT_TRUE(by_speed.unknown.empty());

  HiddenDriveOptions warming;
  warming.seed = 92;
  warming.secret["outside.gyro_warming"] = 2e-4;
  streams = streams_of(record_drive(warming));
  streams.columns = {sampled("clock", [](double t) { return 12.0 + t / 60.0; })};
  const Diagnosis by_time = diagnose(streams, "drive");
  ASSERT_EQ(by_time.unknown.size(), 1U);
  EXPECT_EQ(by_time.unknown[0].depends_on, "time");
  EXPECT_EQ(by_time.unknown[0].inseparable, std::vector<std::string>{"clock"});
}

// Five basis functions of the place against two of a column that is a function of it: the simpler
// description is the place.
TEST(LoggedColumns, OneThatIsAFunctionOfThePlaceGivesWayToIt) {
  HiddenDriveOptions hidden;
  hidden.seed = 99;
  LoggedColumn east{"east", "", {}, {}};
  for (const PoseSample& p : streams_of(record_drive(hidden)).poses) {
    east.t_s.push_back(p.t_s);
    east.values.push_back(p.x);
  }
  std::string why_not;
  const ColumnCovariate covariate(east, 0.0, east.t_s.back(), why_not);
  hidden.acting = [&](double t) { return covariate.terms_at(t)[0]; };
  hidden.secret["outside.gyro_bias_by_column"] = 0.002;
  MotionStreams streams = streams_of(record_drive(hidden));
  streams.columns = {east};
  const Diagnosis found = diagnose(streams, "drive");
  ASSERT_EQ(found.unknown.size(), 1U);
  EXPECT_EQ(found.unknown[0].depends_on, "place");
  EXPECT_EQ(found.unknown[0].inseparable, std::vector<std::string>{"east"});
}

// Two equal columns, for example two sensors of one quantity, are not separable.
TEST(LoggedColumns, TwoThatSayTheSameAreOneAnswerThatNamesBoth) {
  const LoggedColumn first = sampled("inlet", draw_signals(97)[0].of);
  LoggedColumn second = first;
  second.name = "outlet";
  for (double& v : second.values) v = 20.0 + 3.0 * v;
  HiddenDriveOptions hidden;
  hidden.seed = 97;
  std::string why_not;
  const double end = streams_of(record_drive(hidden)).poses.back().t_s;
  const ColumnCovariate covariate(first, 0.0, end, why_not);
  hidden.acting = [&](double t) { return covariate.terms_at(t)[0]; };
  hidden.secret["outside.gyro_bias_by_column"] = 0.003;
  MotionStreams streams = streams_of(record_drive(hidden));
  streams.columns = {first, second};
  // Shifts the origin of the clock.
  const auto later = [](auto& samples) {
    for (auto& one : samples) one.t_s += 1000.0;
  };
  later(streams.poses);
  later(streams.wheels);
  later(streams.steering);
  later(streams.gyro);
  for (LoggedColumn& column : streams.columns)
    for (double& t : column.t_s) t += 1000.0;
  const Diagnosis found = diagnose(streams, "drive");
  EXPECT_TRUE(found.causes.empty());
  ASSERT_EQ(found.unknown.size(), 1U);
  std::vector<std::string> named = found.unknown[0].inseparable;
  named.push_back(found.unknown[0].depends_on);
  std::sort(named.begin(), named.end());
  EXPECT_EQ(named, (std::vector<std::string>{"inlet", "outlet"}));
}

// Four rounds of a ring; what goes with the place is then something else.
FrictionReadings friction_by(const LoggedColumn& column, double size) {
  std::vector<PoseSample> poses;
  std::vector<RawFriction> raw;
  Random random(95, "friction by a column");
  const ColumnCovariate covariate = column_covariates({column}, 0.0, 300.0).at(0);
  for (int k = 0; k <= 3000; ++k) {
    const double t = 0.1 * k;
    const double along = 4.0 * t + 3.0 * std::sin(0.4 * t);
    poses.push_back({t, 48.0 * std::cos(along / 48.0), 48.0 * std::sin(along / 48.0),
                     along / 48.0 + 1.5707963});
    raw.push_back(
        {t, 0.8 + size * covariate.terms_at(t)[0] + 0.05 * random.normal(), 0.05, 1, std::nullopt});
  }
  FrictionReadings readings = friction_readings(poses, raw);
  readings.columns.push_back(covariate);
  return readings;
}

TEST(LoggedColumns, FrictionMayDependOnThemToo) {
  const LoggedColumn column = sampled("supply", draw_signals(96)[1].of);
  const Diagnosis found = diagnose(FrictionProblem(friction_by(column, 0.02)));
  ASSERT_EQ(found.unknown.size(), 1U);
  EXPECT_EQ(found.unknown[0].hook, "bias");
  EXPECT_EQ(found.unknown[0].depends_on, "supply");
  EXPECT_TRUE(found.causes.empty());
  const Diagnosis idle = diagnose(FrictionProblem(friction_by(column, 0.0)));
  EXPECT_TRUE(idle.unknown.empty() && idle.causes.empty());
}

TEST(LoggedColumns, WhatCannotBeUsedIsSaidAndInventsNothing) {
  HiddenDriveOptions nothing;
  nothing.seed = 93;
  MotionStreams streams = streams_of(record_drive(nothing));
  LoggedColumn few = sampled("few", [](double t) { return t; });
  few.t_s.resize(9);
  few.values.resize(9);
  LoggedColumn early = sampled("early", [](double t) { return std::sin(t); });
  early.t_s.resize(200);
  early.values.resize(200);
  streams.columns = {sampled("flat", [](double) { return 12.6; }), few, early};
  const Diagnosis found = diagnose(streams, "drive");
  EXPECT_TRUE(found.causes.empty() && found.unknown.empty());
  EXPECT_TRUE(says(found.notes, "flat does not vary"));
  EXPECT_TRUE(says(found.notes, "few has 9 readings in this drive"));
  EXPECT_TRUE(says(found.notes, "early has values for "));

  streams.columns = {sampled("speed", [](double t) { return std::sin(t); })};
  EXPECT_THROW((void)diagnose(streams, "drive"), BadInput);
  streams.columns = {sampled("volts", [](double t) { return std::sin(t); })};
  streams.columns[0].values[7] = std::numeric_limits<double>::quiet_NaN();
  try {
    (void)diagnose(streams, "drive");
    ADD_FAILURE() << "accepted";
  } catch (const BadInput& bad) {
    EXPECT_EQ(bad.problems().front().field, "column volts sample 8");
  }
}

// By hand: linear between readings; no value outside and in gaps, which counts as the mean.
TEST(LoggedColumns, AreLinearBetweenReadingsAndNothingBeyondThem) {
  LoggedColumn column{"volts", "V", {}, {}};
  for (int i = 0; i <= 100; ++i) {
    if (i > 40 && i < 60) continue;
    column.t_s.push_back(i);
    column.values.push_back(i % 4 < 2 ? 12.0 : 14.0);
  }
  std::string why_not;
  const ColumnCovariate covariate(column, 0.0, 100.0, why_not);
  EXPECT_TRUE(why_not.empty());
  EXPECT_EQ(covariate.axis(), "volts [V]");
  EXPECT_DOUBLE_EQ(*covariate.at(1.25), 12.5);
  EXPECT_FALSE(covariate.at(-0.1) || covariate.at(100.1) || covariate.at(50.0));
  EXPECT_DOUBLE_EQ(covariate.terms_at(50.0)[0], 0.0);
  double mean = 0.0, square = 0.0, both = 0.0, n = 0.0;
  for (double t = 0.0; t <= 100.0; t += 0.1) {
    if (!covariate.at(t)) continue;
    const auto [z, bend] = covariate.terms_at(t);
    mean += z;
    square += z * z;
    both += z * bend;
    n += 1.0;
  }
  EXPECT_NEAR(mean / n, 0.0, 0.01);
  EXPECT_NEAR(square / n, 1.0, 0.01);
  EXPECT_NEAR(both / n, 0.0, 0.01);
}

}  // namespace
}  // namespace roadbook::test
