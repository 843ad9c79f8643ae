#include <gtest/gtest.h>

#include "diagnosis/motion_problem.hpp"
#include "tests/hidden_effects/injector.hpp"
#include "tests/hidden_effects/recorded_streams.hpp"

namespace roadbook {
namespace {

MotionProblem problem_of(std::uint64_t seed, double correlation) {
  test::HiddenDriveOptions options;
  options.seed = seed;
  options.length_m = 150.0;
  options.secret["imu0.correlation"] = correlation;
  return MotionProblem(observe(test::streams_of(test::record_drive(options))));
}

// Correlated readings of the gyro move its bias by more than as many independent ones would: names
// then have to stand the strict rule.
TEST(Noise, WhereReadingsOfTheGyroCorrelateNamesAreNotJudgedByThemselves) {
  for (const std::uint64_t seed : {600U, 601U, 602U, 603U}) {
    EXPECT_EQ(problem_of(seed, 0.4).level_of_names(), 0.0) << seed;
    EXPECT_GT(problem_of(seed, 0.0).level_of_names(), 0.0) << seed;
  }
}

}  // namespace
}  // namespace roadbook
