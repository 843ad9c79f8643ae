#include "diagnosis/streams/coarse_readings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/random.hpp"
#include "diagnosis/diagnose.hpp"
#include "diagnosis/streams/observe.hpp"
#include "tests/diagnosis/hidden_effects/recorded_streams.hpp"
#include "tests/support/expect_words.hpp"
#include "tests/support/found_causes.hpp"

namespace roadbook {
namespace {

constexpr double kTenthDegree = 0.1 * std::numbers::pi / 180.0;

// A steering angle with little noise, read in steps of 0.1 to 0.5 degrees.
test::HiddenDriveOptions coarse(std::uint64_t seed) {
  test::HiddenDriveOptions options;
  options.seed = seed;
  options.steering_sigma_rad = 1e-4;
  Random random(seed, "coarse steering");
  options.steering_step_rad = kTenthDegree * std::pow(5.0, random.uniform());
  return options;
}

TEST(CoarseReadings, AreKnownByTheirStepWhereTheirNoiseDoesNotHideIt) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    test::HiddenDriveOptions options = coarse(seed);
    const auto observed = [&] { return observe(test::streams_of(test::record_drive(options))); };
    EXPECT_NEAR(observed().steering_step_rad, options.steering_step_rad, 1e-9);
    EXPECT_EQ(observed().gyro_step_rad_s, 0.0);
    // Noise as large as a step: the mean of many readings is as accurate as without rounding.
    options.steering_sigma_rad = options.steering_step_rad;
    EXPECT_EQ(observed().steering_step_rad, 0.0);
    options.steering_step_rad = 0.0;
    EXPECT_EQ(observed().steering_step_rad, 0.0);
    options.steering_sigma_rad = 0.0;
    EXPECT_EQ(observed().steering_step_rad, 0.0);
  }
}

TEST(CoarseReadings, WithoutACauseAreSaidAndAreNoNoise) {
  for (std::uint64_t seed = 11; seed <= 14; ++seed) {
    const Diagnosis d = diagnose(test::streams_of(test::record_drive(coarse(seed))), "drive");
    EXPECT_EQ(test::told(d), "") << seed;
    ASSERT_FALSE(d.notes.empty());
    test::expect_words(d.notes.front(), "data fault: steering0 has steps of ");
  }
}

// The sizes of the simulation, within their standard errors.
TEST(CoarseReadings, TellOffsetAndRatioWithIntervalsThatHold) {
  for (const auto& [effect, size] :
       {std::pair{"steering0.offset", 0.01}, {"steering0.ratio", 0.05}}) {
    double squares = 0.0;
    constexpr int kDrives = 4;
    for (std::uint64_t seed = 21; seed < 21 + kDrives; ++seed) {
      test::HiddenDriveOptions options = coarse(seed);
      options.secret[effect] = size;
      const Diagnosis d = diagnose(test::streams_of(test::record_drive(options)), "drive");
      ASSERT_EQ(d.causes.size(), 1U) << test::told(d);
      EXPECT_EQ(d.causes[0].effect, effect);
      EXPECT_TRUE(d.unknown.empty()) << test::told(d);
      squares += std::pow((d.causes[0].size - size) / test::sigma_of(d.causes[0]), 2);
    }
    // Chi-squared of 4: above 18.5 once in a thousand.
    EXPECT_LT(squares, 18.5) << effect;
  }
}

}  // namespace
}  // namespace roadbook
