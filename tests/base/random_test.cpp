#include "base/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace roadbook {
namespace {

TEST(Random, GivesTheSameStreamForTheSameSeedNameAndIndex) {
  Random a(7, "wheels", 3);
  Random b(7, "wheels", 3);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(a(), b());
}

TEST(Random, StreamsOfOtherNamesOrIndicesDiffer) {
  EXPECT_NE(Random(7, "wheels", 3)(), Random(7, "wheels", 4)());
  EXPECT_NE(Random(7, "wheels", 3)(), Random(7, "camera", 3)());
  EXPECT_NE(Random(7, "wheels", 3)(), Random(8, "wheels", 3)());
}

TEST(Random, NormalHasUnitVarianceAndThinTails) {
  Random random(11);
  constexpr int kCount = 100000;
  double sum = 0.0;
  double squares = 0.0;
  int beyond_two = 0;
  for (int i = 0; i < kCount; ++i) {
    const double x = random.normal();
    sum += x;
    squares += x * x;
    beyond_two += std::abs(x) > 2.0 ? 1 : 0;
  }
  EXPECT_NEAR(sum / kCount, 0.0, 4.0 / std::sqrt(kCount));
  EXPECT_NEAR(squares / kCount, 1.0, 4.0 * std::sqrt(2.0 / kCount));
  EXPECT_NEAR(beyond_two / double(kCount), 0.0455, 4.0 * std::sqrt(0.0455 / kCount));
}

TEST(Random, IntegersBelowNAreUniform) {
  Random random(12);
  std::vector<int> counts(7);
  for (int i = 0; i < 70000; ++i) ++counts[random.below(7)];
  for (const int count : counts) EXPECT_NEAR(count, 10000, 4.0 * std::sqrt(10000.0));
}

}  // namespace
}  // namespace roadbook
