#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "diagnosis/motion/motion_problem.hpp"
#include "diagnosis/streams/observe.hpp"
#include "tests/diagnosis/hidden_effects/injector.hpp"
#include "tests/diagnosis/hidden_effects/recorded_streams.hpp"

namespace roadbook {
namespace {

test::Recording recording_of(std::uint64_t seed, const test::Secret& secret) {
  test::HiddenDriveOptions options;
  options.seed = seed;
  options.secret = secret;
  return test::record_drive(options);
}

std::vector<NoiseCause> wheel_noise_of(const test::Recording& recording) {
  const MotionProblem problem(observe(test::streams_of(recording)));
  return problem.noise_causes(problem.nominal());
}

// The noise of single readings is visible next to the wheels' random walk: in the difference of
// both wheels while they roll, in each wheel at standstill.
TEST(WheelNoise, IsNamedWithItsSize) {
  const test::Secret hidden{{"wheels0.outliers", 0.05},
                            {"wheels0.variance(speed)", 0.6},
                            {"wheels0.variance(turn)", 6.0}};
  for (const auto& [effect, size] : hidden)
    for (const std::uint64_t seed : {11U, 12U, 13U}) {
      SCOPED_TRACE(effect + ", seed " + std::to_string(seed));
      const std::vector<NoiseCause> found = wheel_noise_of(recording_of(seed, {{effect, size}}));
      ASSERT_EQ(found.size(), 1U);
      EXPECT_EQ(found[0].effect, effect);
      EXPECT_NEAR(found[0].size, size, 3.0 * found[0].sigma);
    }
}

TEST(WheelNoise, OfADriveWithoutACauseNamesNothing) {
  for (std::uint64_t seed = 700; seed < 712; ++seed) {
    const std::vector<NoiseCause> found = wheel_noise_of(recording_of(seed, {}));
    EXPECT_TRUE(found.empty()) << found[0].effect << " of seed " << seed;
  }
}

// With the random walk of a wheel, correlation looks like noise that falls with speed: neither is
// named.
TEST(WheelNoise, WhoseNeighboursCorrelateIsNotTakenForAnother) {
  for (const double correlation : {0.2, 0.4, 0.6, 0.8})
    for (const NoiseCause& c :
         wheel_noise_of(recording_of(31, {{"wheels0.correlation", correlation}})))
      ADD_FAILURE() << c.effect << " for a correlation of " << correlation;
}

// A stated noise of 0 is not information.
TEST(WheelNoise, StatedAsNothingIsEstimated) {
  test::Recording recording = recording_of(14, {{"wheels0.variance(turn)", 6.0}});
  recording.wheel_model.sigma_distance_per_sqrt_m = 0.0;
  recording.wheel_model.sigma_heading_per_sqrt_m = 0.0;
  recording.wheel_model.sigma_angle_rad = 0.0;
  const std::vector<NoiseCause> found = wheel_noise_of(recording);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].effect, "wheels0.variance(turn)");
  EXPECT_NEAR(found[0].size, 6.0, 3.0 * found[0].sigma);
}

// Rounding to encoder ticks depends on the wheel's speed and correlates between readings: it is no
// noise of readings.
TEST(WheelNoise, TicksOfAnEncoderAreNoNoise) {
  for (const double ticks : {96.0, 512.0, 2048.0}) {
    test::Recording recording = recording_of(21, {});
    const double tick = 2.0 * std::numbers::pi / ticks;
    for (WheelReading& r : recording.wheels) {
      r.left_angle_rad = tick * std::floor(r.left_angle_rad / tick);
      r.right_angle_rad = tick * std::floor(r.right_angle_rad / tick);
    }
    for (const NoiseCause& c : wheel_noise_of(recording))
      EXPECT_FALSE(c.effect.starts_with("wheels0.")) << c.effect << " of " << ticks << " ticks";
  }
}

}  // namespace
}  // namespace roadbook
