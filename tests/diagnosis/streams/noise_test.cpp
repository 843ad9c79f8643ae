#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "diagnosis/diagnose.hpp"
#include "diagnosis/motion/motion_problem.hpp"
#include "diagnosis/streams/observe.hpp"
#include "tests/diagnosis/hidden_effects/injector.hpp"
#include "tests/diagnosis/hidden_effects/recorded_streams.hpp"
#include "tests/support/found_causes.hpp"

namespace roadbook {
namespace {

using test::Secret;

MotionProblem problem_of(std::uint64_t seed, double correlation) {
  test::HiddenDriveOptions options;
  options.seed = seed;
  options.length_m = 150.0;
  options.secret["imu0.correlation"] = correlation;
  return MotionProblem(observe(test::streams_of(test::record_drive(options))));
}

Diagnosis diagnosed(std::uint64_t seed, const Secret& secret, bool exact_poses) {
  test::HiddenDriveOptions options;
  options.seed = seed;
  options.secret = secret;
  if (exact_poses) options.pose_sigma_m = options.pose_sigma_rad = 0.0;
  return diagnose(test::streams_of(test::record_drive(options)), "drive");
}

// Correlated gyro readings move its bias by more than independent ones, so the strict acceptance
// rule applies.
TEST(Noise, WhereReadingsOfTheGyroCorrelateNamesAreNotJudgedByThemselves) {
  for (const std::uint64_t seed : {600U, 601U, 602U, 603U}) {
    EXPECT_EQ(problem_of(seed, 0.4).level_of_names(), 0.0) << seed;
    EXPECT_GT(problem_of(seed, 0.0).level_of_names(), 0.0) << seed;
  }
}

// The diagnosis must not explain slow errors of a gyro as motion, which would create generic
// effects.
TEST(Noise, ThatCorrelatesIsNoTermOfTheGrammar) {
  for (const double correlation : {0.75, 0.9})
    for (const bool exact_poses : {true, false}) {
      const Diagnosis d = diagnosed(610, {{"imu0.correlation", correlation}}, exact_poses);
      for (const UnknownCause& u : d.unknown)
        ADD_FAILURE() << u.hook << " ~ " << u.depends_on << " for " << correlation;
      ASSERT_EQ(d.causes.size(), 1U);
      EXPECT_EQ(d.causes[0].effect, "imu0.correlation");
    }
}

// Correlation reduces the effective number of readings for slowly varying effects.
TEST(Noise, ThatCorrelatesWidensIntervalsByAsMuch) {
  for (const auto& [noise, effect, size] :
       {std::tuple{"imu0.correlation", "imu0.gyro_bias", 0.003},
        std::tuple{"steering0.correlation", "steering0.offset", 0.006}}) {
    double squares = 0.0;
    constexpr int kDrives = 3;
    for (std::uint64_t seed = 700; seed < 700 + kDrives; ++seed) {
      const Diagnosis d = diagnosed(seed, {{noise, 0.9}, {effect, size}}, false);
      ASSERT_EQ(d.causes.size(), 2U) << effect << ", " << seed;
      EXPECT_EQ(d.causes[0].effect, effect);
      squares += std::pow((d.causes[0].size - size) / test::sigma_of(d.causes[0]), 2);
    }
    // Chi-squared of 3: above 16 once in a thousand.
    EXPECT_LT(squares, 16.3) << effect;
  }
}

}  // namespace
}  // namespace roadbook
