#include "drive/stamps.hpp"

#include <gtest/gtest.h>

namespace roadbook {
namespace {

struct Checked {
  StreamSummary summary;
  std::vector<Problem> problems;
};

// 200 rows at equal intervals, against the rate that the sensor.yaml states.
Checked check_rate(std::int64_t interval_ns, double stated_hz) {
  ProblemList problems;
  StampCheck check("wheels0/data.csv", problems);
  for (std::int64_t i = 0; i < 200; ++i)
    EXPECT_TRUE(check.add(1'000'000'000'000 + i * interval_ns, 2 + i));
  StampLimits limits;
  limits.declared_rate_hz = stated_hz;
  const StreamSummary summary = check.finish("wheels0", limits);
  return {summary, problems.problems()};
}

TEST(Stamps, TheRateIsThatOfTheIntervals) {
  const Checked checked = check_rate(20'000'000, 50.0);
  EXPECT_DOUBLE_EQ(checked.summary.rate_hz, 50.0);
  EXPECT_EQ(checked.summary.rows, 200U);
  EXPECT_EQ(checked.summary.gaps, 0U);
  EXPECT_TRUE(checked.problems.empty());
}

// Stamps in microseconds or in picoseconds are 1000 times off, whatever the rate itself.
TEST(Stamps, ARateAThousandTimesOffTheStatedOneIsAnotherUnit) {
  for (const auto& [interval_ns, unit] :
       {std::pair<std::int64_t, std::string>{100'000, "larger"}, {100'000'000'000, "smaller"}}) {
    const Checked checked = check_rate(interval_ns, 10.0);
    ASSERT_EQ(checked.problems.size(), 1U);
    EXPECT_EQ(checked.problems[0].severity, Severity::kError);
    EXPECT_NE(checked.problems[0].want.find(unit), std::string::npos) << checked.problems[0].want;
  }
}

TEST(Stamps, ARateTwiceTheStatedOneIsAWarningAndATenthMoreIsNone) {
  for (const std::int64_t interval_ns : {10'000'000, 40'000'000}) {
    const Checked twice = check_rate(interval_ns, 50.0);
    ASSERT_EQ(twice.problems.size(), 1U);
    EXPECT_EQ(twice.problems[0].severity, Severity::kWarning);
  }
  EXPECT_TRUE(check_rate(18'000'000, 50.0).problems.empty());
}

TEST(Stamps, AGapIsOneIntervalOfMoreThanTwoAndAHalf) {
  for (const auto& [missing, gaps] : {std::pair<std::int64_t, std::size_t>{1, 0}, {2, 1}}) {
    ProblemList problems;
    StampCheck check("cam0/data.csv", problems);
    for (std::int64_t i = 0; i < 50; ++i)
      EXPECT_TRUE(check.add((i < 25 ? i : i + missing) * 100'000'000, 2 + i));
    EXPECT_EQ(check.finish("cam0", {}).gaps, gaps);
    EXPECT_EQ(problems.problems().size(), gaps);
  }
}

TEST(Stamps, ARowThatRepeatsOrGoesBackIsRefused) {
  ProblemList problems;
  StampCheck check("imu0/data.csv", problems);
  EXPECT_TRUE(check.add(100, 2));
  EXPECT_FALSE(check.add(100, 3));
  EXPECT_FALSE(check.add(99, 4));
  EXPECT_TRUE(check.add(101, 5));
  EXPECT_EQ(problems.error_count(), 2U);
}

}  // namespace
}  // namespace roadbook
