#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/evaluation/people_scene.hpp"
#include "apps/evaluation/people_study.hpp"

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
  EXPECT_GT(score.precision(), 0.9);
  EXPECT_LT(score.median_error_m(), 0.3);
}

// Somebody tall beyond the range looks like somebody short within it: who is not listed there
// counts as a false alarm, and is taught to be nobody.
TEST(People, PeopleBeyondTheRangeAreKnownAndNeedNotBeFound) {
  ScenarioOptions small;
  small.size = "small";
  small.visit = 1;
  const PeopleScene scene("zurich", small, 1, 0);
  constexpr double kRange = 3.0;  // in the small place nobody is far beyond 10 m
  int beyond = 0;
  for (double t = 0.5; t < scene.duration_s() && beyond < 3; t += 0.7) {
    const PeopleTruth::Instant there = scene.at(t, kRange).there;
    for (std::size_t i = 0; i < there.people.size(); ++i) {
      const TruePerson& person = there.people[i];
      const auto camera = static_cast<std::size_t>(person.box.camera);
      const Eigen::Vector3d eye = scene.cameras()[camera].mounted().T_vehicle_camera.translation();
      const double far_m =
          (there.feet[static_cast<std::size_t>(there.who[i])] - eye.head<2>()).norm();
      EXPECT_FALSE(person.clear && far_m > kRange) << far_m;
      if (far_m > 1.4 * kRange) ++beyond;
    }
  }
  EXPECT_GE(beyond, 3);
}

// Of nobody no share is found: that is null in JSON, not 0.
TEST(People, SharesOfNothingAreNoNumbers) {
  PeopleScore score;
  EXPECT_TRUE(std::isnan(score.precision()));
  EXPECT_TRUE(std::isnan(score.recall()));
  score.wrong = 2;
  EXPECT_EQ(score.precision(), 0.0);
  EXPECT_TRUE(std::isnan(score.recall()));
  EXPECT_EQ(nlohmann::json(score.recall()).dump(), "null");
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
