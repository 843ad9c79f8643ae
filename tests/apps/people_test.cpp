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

}  // namespace
}  // namespace roadbook
