#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"
#include "tests/diagnosis/hidden_effects/seed_of_today.hpp"
#include "tests/diagnosis/hidden_effects/simulated_drive.hpp"
#include "tests/support/found_causes.hpp"

namespace roadbook::test {
namespace {

// Noise of the wheels: outliers in addition to the usual scatter, and a variance that grows with
// speed or turn rate.
TEST(SimulatedNoise, OfTheWheelsIsFoundFromTheFiles) {
  const std::uint64_t seed = seed_of_today();
  const EffectSizes hidden{{"wheels0.outliers", 0.05},
                           {"wheels0.variance(speed)", 0.6},
                           {"wheels0.variance(turn)", 8.0}};
  for (const auto& [effect, size] : hidden) {
    SCOPED_TRACE(effect);
    Random random(seed, "simulated " + effect);
    const Diagnosis found = simulated_and_diagnosed({{effect, size}}, random() >> 1U);
    EXPECT_TRUE(found.unknown.empty());
    ASSERT_EQ(found.causes.size(), 1U);
    const FoundCause& cause = found.causes.front();
    EXPECT_EQ(cause.effect, effect);
    EXPECT_NEAR(cause.size, size, 4.0 * sigma_of(cause));
  }
}

}  // namespace
}  // namespace roadbook::test
