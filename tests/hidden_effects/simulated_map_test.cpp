#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <iostream>

#include "base/random.hpp"
#include "diagnosis/diagnose.hpp"
#include "diagnosis/drive_streams.hpp"
#include "sim/simulate.hpp"
#include "tests/drive/drive_fixture.hpp"

namespace roadbook::test {
namespace {

std::uint64_t seed_of_today() {
  if (const char* given = std::getenv("ROADBOOK_HIDDEN_SEED")) return std::stoull(given);
  return static_cast<std::uint64_t>(std::time(nullptr) / 86400);
}

// A lap of the car park without images: `roadbook simulate zurich --no-images --effect ...`, then
// `roadbook diagnose`, from the files alone.
Diagnosis simulated_and_diagnosed(const EffectSizes& secret, std::uint64_t seed) {
  const TemporaryFolder folder;
  Scenario scenario = load_scenario("zurich", {});
  scenario.ground.texel_m = 0.1;  // nobody looks
  SimulateOptions options;
  options.effects = secret;
  options.seed = seed;
  options.images = false;
  (void)simulate(scenario, folder.path() / "drive", options);
  std::filesystem::remove_all(folder.path() / "drive" / "truth");
  const Drive drive = Drive::open(folder.path() / "drive");
  return diagnose(motion_streams(drive), "drive");
}

// Effect, sign and size from the date, over the practical range.
TEST(SimulatedMap, AScaleOrBendOfTheMapBehindTheReferencePosesIsFoundWithItsSize) {
  const std::uint64_t seed = seed_of_today();
  std::cout << "ROADBOOK_HIDDEN_SEED=" << seed << "\n";
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
    const double sigma = (cause.high - cause.low) / (2.0 * 1.96);
    EXPECT_NEAR(cause.size, size, 4.0 * sigma);
    EXPECT_GT(std::abs(size), 5.0 * sigma);
    EXPECT_GT(cause.gain.total, 0.0);
  }
}

TEST(SimulatedMap, WithoutOneNothingIsNamed) {
  const Diagnosis found = simulated_and_diagnosed({}, Random(seed_of_today(), "no map")() >> 1U);
  EXPECT_TRUE(found.causes.empty() && found.unknown.empty());
}

}  // namespace
}  // namespace roadbook::test
