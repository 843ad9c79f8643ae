#include "diagnosis/known_causes.hpp"

#include <gtest/gtest.h>

#include "diagnosis/inference/extended_model.hpp"

namespace roadbook {
namespace {

// One effect of 0.010 with a standard error of 0.001, among ten candidates.
Diagnosis found() {
  Diagnosis d;
  d.looked_for = {"a", "b", "c", "d", "e", "f", "g", "h", "friction0.drying", "range0.short"};
  FoundCause cause;
  cause.effect = "range0.short";
  cause.size = 0.010;
  cause.low = 0.010 - 1.96e-3;
  cause.high = 0.010 + 1.96e-3;
  d.causes = {cause};
  d.extended = {{cause.effect, cause.size}};
  return d;
}

TEST(KnownCauses, WhatTheModelKnowsIsNotSaidAgain) {
  Diagnosis d = found();
  take_off_known({{"range0.short", 0.0115}, {"imu0.gyro_bias", 0.1}}, d);
  EXPECT_TRUE(d.causes.empty());
  // The model keeps its known effects; effects that were not searched for belong to other streams.
  EXPECT_EQ(d.extended, (EffectSizes{{"range0.short", 0.0115}}));
}

TEST(KnownCauses, WhatDiffersSurelyIsSaidAsTheDifference) {
  Diagnosis d = found();
  take_off_known({{"range0.short", 0.002}}, d);
  ASSERT_EQ(d.causes.size(), 1U);
  EXPECT_NEAR(d.causes[0].size, 0.008, 1e-12);
  EXPECT_NEAR(d.causes[0].low, 0.008 - 1.96e-3, 1e-12);
  EXPECT_NEAR(d.causes[0].gain.total, 31.0, 1e-6);  // 8 standard errors
  EXPECT_NEAR(d.extended.at("range0.short"), 0.010, 1e-12);
}

TEST(KnownCauses, OtherCausesStayAsTheyAre) {
  Diagnosis d = found();
  take_off_known({{"friction0.slip_bias", 0.002}}, d);
  ASSERT_EQ(d.causes.size(), 1U);
  EXPECT_EQ(d.causes[0].size, 0.010);
  EXPECT_EQ(d.extended, (EffectSizes{{"range0.short", 0.010}}));
}

// An effect of one place, or from one time on.
FoundCause placed(const std::string& effect, double size, double evidence) {
  FoundCause cause;
  cause.effect = effect;
  cause.size = size;
  cause.evidence = evidence;
  cause.in_place = true;
  return cause;
}

TEST(KnownCauses, AKnownSurfaceWithoutAPlaceIsTakenOffNoDiscThatIsFound) {
  Diagnosis d = found();
  d.causes.push_back(placed("friction0.extra_class", -0.2, 50.0));
  d.causes.push_back(placed("friction0.extra_class", 0.3, 40.0));
  d.extended.clear();
  extend_model(d);
  EXPECT_EQ(d.extended, (EffectSizes{{"range0.short", 0.010}}));
  EXPECT_NE(d.causes[1].note.find("not written with --write-model"), std::string::npos);
  take_off_known({{"friction0.extra_class", -0.2}}, d);
  ASSERT_EQ(d.causes.size(), 3U);
  EXPECT_EQ(d.causes[1].size, -0.2);
  EXPECT_EQ(d.causes[2].size, 0.3);
  EXPECT_FALSE(d.extended.contains("friction0.extra_class"));
  ASSERT_EQ(d.notes.size(), 1U);
  EXPECT_TRUE(d.notes[0].starts_with("friction0.extra_class of the known model has no place"));
}

// A model holds one hinge: the most significant one, and a known one before any other.
TEST(KnownCauses, OfSeveralPlacesOfOneNameTheModelHasOneAndNeverTheirSum) {
  Diagnosis d;
  d.causes = {placed("ground.hinge", 0.02, 40.0), placed("ground.hinge", 0.05, 90.0)};
  extend_model(d);
  EXPECT_EQ(d.extended, (EffectSizes{{"ground.hinge", 0.05}}));
  add_known({{"ground.hinge", 0.08}}, d);
  EXPECT_EQ(d.extended, (EffectSizes{{"ground.hinge", 0.08}}));
  for (const FoundCause& c : d.causes)
    EXPECT_NE(c.note.find("not written with --write-model"), std::string::npos);
  Diagnosis again;
  again.causes = {placed("ground.hinge", 0.02, 40.0), placed("ground.hinge", -0.01, 9.0)};
  again.causes[1].at_known = true;  // the excess over the known one
  extend_model(again);
  add_known({{"ground.hinge", 0.08}}, again);
  EXPECT_NEAR(again.extended.at("ground.hinge"), 0.07, 1e-12);
}

}  // namespace
}  // namespace roadbook
