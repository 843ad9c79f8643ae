#include "diagnosis/streams/variance_samples.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"

namespace roadbook {
namespace {

constexpr int kFreedom = 6;

// Samples of a car whose speed and turn rate correlate by 0.8. The log variance grows by the given
// amounts per standard deviation of either (1 m/s, 0.1 rad/s).
std::vector<VarianceSample> looks_by(double by_speed, double by_turn, std::uint64_t seed) {
  Random random(seed, "looks");
  std::vector<VarianceSample> looks;
  for (int k = 0; k < 1500; ++k) {
    const double s = random.normal();
    const double t = 0.8 * s + 0.6 * random.normal();
    double square = 0.0;
    for (int i = 0; i < kFreedom; ++i) square += std::pow(random.normal(), 2) / kFreedom;
    looks.push_back(
        {square * std::exp(by_speed * s + by_turn * t), kFreedom, 3.0 + s, 0.5 + 0.1 * t});
  }
  return looks;
}

// Each slope is estimated with the other in the model, so each has its own size. Alone, the weaker
// would be too large by 0.8 of the other.
TEST(NoiseLooks, SpeedAndTurnThatGoTogetherHaveEachItsOwnSize) {
  for (const auto& [by_speed, by_turn] : {std::pair{0.5, 0.3}, std::pair{0.3, 0.5}}) {
    double squares = 0.0;
    constexpr int kSeeds = 10;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      const VarianceSlopes slopes = variance_slopes("imu0", looks_by(by_speed, by_turn, seed), {});
      EXPECT_TRUE(is_sure(slopes.by_speed) && is_sure(slopes.by_turn)) << seed;
      squares += std::pow((slopes.by_speed.size - by_speed) / slopes.by_speed.sigma, 2) +
                 std::pow((slopes.by_turn.size - 10.0 * by_turn) / slopes.by_turn.sigma, 2);
      EXPECT_DOUBLE_EQ(slopes.speed, slopes.by_speed.size);
      EXPECT_DOUBLE_EQ(slopes.turn, slopes.by_turn.size);
    }
    // Chi-squared with 20 degrees of freedom, of pairs with correlation -0.8: above 55 once in a
    // thousand.
    EXPECT_LT(squares, 55.0) << by_speed << ", " << by_turn;
  }
}

// One slope alone explains the apparent other one.
TEST(NoiseLooks, OfTwoThatGoTogetherTheOneThatActsIsSaid) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const VarianceSlopes by_speed = variance_slopes("imu0", looks_by(0.4, 0.0, seed), {});
    EXPECT_TRUE(is_sure(by_speed.by_speed) && !is_sure(by_speed.by_turn)) << seed;
    const VarianceSlopes by_turn = variance_slopes("imu0", looks_by(0.0, 0.4, seed), {});
    EXPECT_TRUE(is_sure(by_turn.by_turn) && !is_sure(by_turn.by_speed)) << seed;
  }
}

// The known part is removed; the rest is reported.
TEST(NoiseLooks, OfAVarianceThatIsKnownOnlyTheRestIsSaid) {
  NoiseImperfections known;
  known.variance_by_speed = 0.5;
  known.variance_by_turn = 1.0;
  const VarianceSlopes slopes = variance_slopes("imu0", looks_by(0.5, 0.3, 3), known);
  EXPECT_FALSE(is_sure(slopes.by_speed));
  EXPECT_NEAR(slopes.by_turn.size, 2.0, 4.0 * slopes.by_turn.sigma);
  EXPECT_DOUBLE_EQ(slopes.speed, 0.5);
  EXPECT_DOUBLE_EQ(slopes.turn, 1.0 + slopes.by_turn.size);
}

}  // namespace
}  // namespace roadbook
