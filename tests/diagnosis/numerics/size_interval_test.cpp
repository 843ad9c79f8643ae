#include "diagnosis/numerics/size_interval.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/inference/plausible_size.hpp"
#include "tests/support/expect_words.hpp"

namespace roadbook {
namespace {

TEST(SizeInterval, OfSharesAndCorrelationsStaysBetweenTheirBounds) {
  const SizeInterval share = interval95("imu0.outliers", 0.14, 0.135);
  EXPECT_GT(share.low, 0.0);
  EXPECT_LT(share.low, 0.05);
  EXPECT_GT(share.high, 0.4);
  EXPECT_LT(share.high, 1.0);
  const SizeInterval correlation = interval95("poses.correlation", 0.987, 0.011);
  EXPECT_NEAR(correlation.low, 0.987 - 1.96 * 0.011, 1e-12);
  EXPECT_EQ(correlation.high, 0.999);
}

// Where the bounds are far away the scale makes no difference.
TEST(SizeInterval, OfAnErrorThatIsSmallIsTheUsualOne) {
  for (const char* effect : {"range0.maximum", "imu0.correlation", "wheels0.radius"}) {
    const SizeInterval i = interval95(effect, 0.3, 0.001);
    EXPECT_NEAR(i.low, 0.3 - 1.96 * 0.001, 2e-5) << effect;
    EXPECT_NEAR(i.high, 0.3 + 1.96 * 0.001, 2e-5) << effect;
  }
}

TEST(SizeInterval, OfOtherEffectsIsCutAtTheBounds) {
  EXPECT_EQ(interval95("imu0.variance(speed)", 4.5, 1.0).high, 5.0);
  EXPECT_NEAR(interval95("imu0.variance(speed)", 4.5, 1.0).low, 2.54, 1e-9);
}

TEST(SizeInterval, OfADifferenceToAKnownSizeMayBeBelowNothing) {
  EXPECT_NEAR(interval95("imu0.outliers", -0.02, 0.005).low, -0.0298, 1e-9);
  EXPECT_NEAR(interval95("no.effect", 0.5, 1.0).high, 2.46, 1e-9);
}

FoundCause cause_of(const std::string& effect, double size) {
  FoundCause cause;
  cause.effect = effect;
  cause.size = size;
  return cause;
}

TEST(SizeDoubt, StandsWhereASizeIsFarBeyondThePlausible) {
  test::expect_words(size_doubt(cause_of("steering0.ratio", 0.82)),
                     "doubtful: 16 times the plausible size (0.05); check unit and sign, or the "
                     "true cause is not in the catalogue");
  test::expect_words(size_doubt(cause_of("imu0.latency", -0.415)), "(0.05 s)");
  test::expect_words(size_doubt(cause_of("cam2.focal", 0.08)), "doubtful: 8 times");
  EXPECT_EQ(size_doubt(cause_of("steering0.ratio", -0.2)), "");
  EXPECT_EQ(size_doubt(cause_of("wheels0.locked_axle", 1.0)), "");
  EXPECT_EQ(size_doubt(cause_of("poses.outliers", 0.2)), "");
}

}  // namespace
}  // namespace roadbook
