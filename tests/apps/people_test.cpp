#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "apps/people_study.hpp"

namespace roadbook {
namespace {

// The short version of `roadbook evaluate people`: half-size images, two visits, the second on
// another crossing with other people and parked cars.
TEST(People, AFewClicksInOneVisitFindPeopleInTheNext) {
  PeopleStudyOptions options;
  options.small = true;
  options.visits = 2;
  options.step_s = 0.7;
  options.detect.batch = 5;
  options.held_out_looks = 0;
  const auto visits = study_people(options);
  ASSERT_EQ(visits.size(), 2U);
  ASSERT_GE(visits[0].rounds.size(), 3U);
  EXPECT_LE(visits[0].rounds.back().drawn, 24);
  const PeopleScore& score = visits[1].score;
  ASSERT_GT(score.people, 30U);
  std::cout << "people " << score.people << ", precision " << score.precision() << ", recall "
            << score.recall() << ", feet " << score.median_error_m() << " m\n";
  double normalised = 0.0;
  for (const double m : score.mahalanobis2)
    normalised += m / static_cast<double>(score.mahalanobis2.size());
  std::cout << "squared normalised error of feet " << normalised << " (2 expected)\n";
  // Mean of chi-square with 2 degrees of freedom over 39 people: 4 standard deviations.
  EXPECT_NEAR(normalised, 2.0, 4.0 * 2.0 / std::sqrt(39.0));
  EXPECT_GT(score.recall(), 0.8);
  EXPECT_GT(score.precision(), 0.85);
  EXPECT_LT(score.median_error_m(), 0.3);
}

// By hand: of four that were said to be somebody with 0.55 two are (0.05 off), of one with 0.9 one
// (0.1 off): (4 * 0.05 + 0.1) / 5.
TEST(People, TheCalibrationErrorIsTheMeanDistanceOfSaidAndTrue) {
  PeopleScore score;
  EXPECT_EQ(score.calibration_error(), 0.0);
  score.said = {{0.55, true}, {0.55, false}, {0.55, true}, {0.55, false}};
  PeopleScore more;
  more.said = {{0.9, true}};
  score.add(more);
  EXPECT_NEAR(score.calibration_error(), 0.06, 1e-12);
}

}  // namespace
}  // namespace roadbook
