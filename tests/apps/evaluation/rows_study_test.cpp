#include "apps/evaluation/rows_study.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace roadbook {
namespace {

// This is the short version of `roadbook evaluate rows`: rows of eight and of four spaces along
// half a round.
TEST(RowsStudy, EqualRowsTakePartAndHarmNoMapAndUnequalOnesDoNot) {
  const RowsDrive drive{
      .name = "", .scenario = "stuttgart", .size = "small", .seconds = 15.0, .image_scale = 0.5};
  const auto outcomes =
      study_rows(drive, {{.name = "drawn"}, {.name = "uneven", .uneven_m = 0.4}}, 1, 0);
  ASSERT_EQ(outcomes.size(), 2U);
  for (const RowsOutcome& outcome : outcomes) {
    EXPECT_GT(outcome.labelled, 15U);
    EXPECT_GT(outcome.off.ate_rmse_m, 0.0);
  }
  EXPECT_GE(outcomes[0].used.rows, 1U);
  EXPECT_GE(outcomes[0].used.spaces, 8U);
  // Short rows add almost no information to that of the cameras, and they do not bend the map that
  // the cameras give.
  EXPECT_NEAR(outcomes[0].on.ate_rmse_m, outcomes[0].off.ate_rmse_m,
              0.25 * outcomes[0].off.ate_rmse_m);
  EXPECT_NEAR(outcomes[0].on.label_rmse_m, outcomes[0].off.label_rmse_m,
              0.25 * outcomes[0].off.label_rmse_m);
  EXPECT_EQ(outcomes[1].used.rows, 0U);
  EXPECT_EQ(outcomes[1].on.ate_rmse_m, outcomes[1].off.ate_rmse_m);  // bit-identical
}

TEST(RowsStudy, AnIntervalOfRatiosIsThatOfTheirLogarithms) {
  const RatioInterval r = ratio_interval({0.5, 2.0});
  // The logarithms are +-log 2, so the standard error is log 2 with one degree of freedom.
  const double half = 12.7062 * std::log(2.0);
  EXPECT_NEAR(r.ratio, 1.0, 1e-12);
  EXPECT_NEAR(std::log(r.low), -half, 1e-4);
  EXPECT_NEAR(std::log(r.high), half, 1e-4);
  EXPECT_EQ(ratio_interval({0.9, 0.9, 0.9}).high, ratio_interval({0.9, 0.9, 0.9}).low);
}

}  // namespace
}  // namespace roadbook
