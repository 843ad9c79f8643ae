#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/random.hpp"
#include "tests/diagnosis/hidden_effects/seed_of_today.hpp"
#include "tests/diagnosis/hidden_effects/simulated_drive.hpp"
#include "tests/support/found_causes.hpp"

namespace roadbook::test {
namespace {

// Effect, sign and size from the date, over the practical range.
TEST(SimulatedMap, AScaleOrBendOfTheMapBehindTheReferencePosesIsFoundWithItsSize) {
  const std::uint64_t seed = seed_of_today();
  for (std::uint64_t i = 0; i < 2; ++i) {
    Random random(seed, "simulated map", i);
    const std::string effect = i == 0 ? "map.scale" : "map.bend";
    const double low = i == 0 ? 0.003 : 5e-5;
    const double high = i == 0 ? 0.02 : 3e-4;
    const double sign = random.uniform() < 0.5 ? -1.0 : 1.0;
    const double size = sign * low * std::pow(high / low, random.uniform());
    const Diagnosis found = simulated_and_diagnosed({{effect, size}}, random() >> 1U);
    SCOPED_TRACE(effect + " " + std::to_string(size));
    ASSERT_FALSE(found.causes.empty());
    EXPECT_EQ(found.causes.size(), 1U);
    EXPECT_TRUE(found.unknown.empty());
    const FoundCause& cause = found.causes.front();
    EXPECT_EQ(cause.effect, effect);
    EXPECT_NEAR(cause.size, size, 4.0 * sigma_of(cause));
    EXPECT_GT(std::abs(size), 5.0 * sigma_of(cause));
    EXPECT_GT(cause.gain.total, 0.0);
  }
}

// The place has a hinge: its slope turns the car as well, and the reference says so.
TEST(SimulatedMap, ATiltedImuIsFoundOnAnEdgeOfTheGround) {
  const Diagnosis found =
      simulated_and_diagnosed({{"imu0.tilt_roll", 0.06}, {"imu0.tilt_pitch", -0.04}}, 5);
  SCOPED_TRACE(told(found));
  ASSERT_EQ(found.causes.size(), 2U);
  EXPECT_TRUE(found.unknown.empty());
  for (const FoundCause& cause : found.causes) {
    const double size = cause.effect == "imu0.tilt_roll" ? 0.06 : -0.04;
    EXPECT_TRUE(cause.effect.starts_with("imu0.tilt_")) << cause.effect;
    EXPECT_NEAR(cause.size, size, std::max(4.0 * sigma_of(cause), 1e-3));
  }
}

TEST(SimulatedMap, WithoutOneNothingIsNamed) {
  const Diagnosis found = simulated_and_diagnosed({}, Random(seed_of_today(), "no map")() >> 1U);
  EXPECT_TRUE(found.causes.empty() && found.unknown.empty());
}

}  // namespace
}  // namespace roadbook::test
