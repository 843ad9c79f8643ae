#include "diagnosis/known_causes.hpp"

#include <gtest/gtest.h>

namespace roadbook {
namespace {

// One cause of 0.010 with a standard error of 0.001, among ten names.
Diagnosis found() {
  Diagnosis d;
  d.looked_for = {"a", "b", "c", "d", "e", "f", "g", "h", "i", "friction0.speed_bias"};
  FoundCause cause;
  cause.effect = "friction0.speed_bias";
  cause.size = 0.010;
  cause.low = 0.010 - 1.96e-3;
  cause.high = 0.010 + 1.96e-3;
  d.causes = {cause};
  d.extended = {{cause.effect, cause.size}};
  return d;
}

TEST(KnownCauses, WhatTheModelKnowsIsNotSaidAgain) {
  Diagnosis d = found();
  take_off_known({{"friction0.speed_bias", 0.0115}, {"imu0.gyro_bias", 0.1}}, d);
  EXPECT_TRUE(d.causes.empty());
  // The model keeps what it knew; a name that was not looked for is another stream's.
  EXPECT_EQ(d.extended, (EffectSizes{{"friction0.speed_bias", 0.0115}}));
}

TEST(KnownCauses, WhatDiffersSurelyIsSaidAsTheDifference) {
  Diagnosis d = found();
  take_off_known({{"friction0.speed_bias", 0.002}}, d);
  ASSERT_EQ(d.causes.size(), 1U);
  EXPECT_NEAR(d.causes[0].size, 0.008, 1e-12);
  EXPECT_NEAR(d.causes[0].low, 0.008 - 1.96e-3, 1e-12);
  EXPECT_NEAR(d.causes[0].gain.total, 31.0, 1e-6);  // 8 standard errors
  EXPECT_NEAR(d.extended.at("friction0.speed_bias"), 0.010, 1e-12);
}

TEST(KnownCauses, OtherCausesStayAsTheyAre) {
  Diagnosis d = found();
  take_off_known({{"friction0.slip_bias", 0.002}}, d);
  ASSERT_EQ(d.causes.size(), 1U);
  EXPECT_EQ(d.causes[0].size, 0.010);
  EXPECT_EQ(d.extended, (EffectSizes{{"friction0.speed_bias", 0.010}}));
}

}  // namespace
}  // namespace roadbook
