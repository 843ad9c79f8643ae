#include <gtest/gtest.h>

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

TEST(SimulatedMap, WithoutOneNothingIsNamed) {
  const Diagnosis found = simulated_and_diagnosed({}, Random(seed_of_today(), "no map")() >> 1U);
  EXPECT_TRUE(found.causes.empty() && found.unknown.empty());
}

}  // namespace
}  // namespace roadbook::test
