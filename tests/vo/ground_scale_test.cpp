#include "vo/ground_scale.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"

namespace roadbook {
namespace {

// A camera 1.5 m up in units that are `truth` too small: a third of the points lie on the ground,
// the others on walls at any height.
std::vector<double> ratios(double truth, int ground, int others, std::uint64_t seed) {
  Random random(seed);
  std::vector<double> list;
  for (int i = 0; i < ground; ++i) list.push_back(1.5 / ((1.5 + random.normal(0.0, 0.02)) / truth));
  for (int i = 0; i < others; ++i) list.push_back(1.5 / (random.uniform(0.05, 1.5) / truth));
  return list;
}

TEST(GroundScale, FindsTheGroundAmongHigherPoints) {
  for (const double truth : {0.3, 1.0, 4.0}) {
    const auto found = ground_scale(ratios(truth, 100, 200, 5));
    ASSERT_TRUE(found);
    // 100 points of 1.3 % each, and a few walls that end near the ground.
    EXPECT_NEAR(found->scale, truth, 0.012 * truth);
  }
}

// The error of the mean of n points is that of one point over the root of n.
TEST(GroundScale, TheSigmaIsTheStandardErrorOfTheMode) {
  for (const int count : {100, 400}) {
    const auto found = ground_scale(ratios(1.0, count, 0, 8));
    ASSERT_TRUE(found);
    const double expected = 0.02 / 1.5 / std::sqrt(count);
    EXPECT_NEAR(found->sigma, expected, 0.15 * expected);
    EXPECT_NEAR(found->support, count, 1);
  }
}

TEST(GroundScale, SaysNothingWithoutGround) {
  EXPECT_FALSE(ground_scale(ratios(1.0, 0, 12, 6)));
  EXPECT_FALSE(ground_scale({}));
}

}  // namespace
}  // namespace roadbook
