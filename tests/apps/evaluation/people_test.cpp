#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/evaluation/people_scene.hpp"
#include "apps/evaluation/people_study.hpp"

namespace roadbook {
namespace {

// This is the short version of `roadbook evaluate people`: half-size images and two visits. In the
// second visit, other people are on another crossing and other cars are parked.
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
  // Over 39 people, chi-square with 2 degrees of freedom has this mean; the bound is 4 standard
  // errors of the mean.
  EXPECT_NEAR(normalised, 2.0, 4.0 * 2.0 / std::sqrt(39.0));
  EXPECT_GT(score.recall(), 0.8);
  EXPECT_GT(score.precision(), 0.9);
  EXPECT_LT(score.median_error_m(), 0.3);
}

// A tall person beyond the range looks like a short person within the range. The truth therefore
// also lists people beyond the range. Otherwise a detection of such a person would count as a false
// alarm, and training would use it as a negative example.
TEST(People, PeopleBeyondTheRangeAreKnownAndNeedNotBeFound) {
  ScenarioOptions small;
  small.size = "small";
  small.visit = 1;
  const PeopleScene scene("zurich", small, 1, 0);
  constexpr double kRange = 3.0;  // in the small place no person is far beyond 10 m
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

// Without any person in the truth, recall is undefined: JSON has null, not 0.
TEST(People, SharesOfNothingAreNoNumbers) {
  PeopleScore score;
  EXPECT_TRUE(std::isnan(score.precision()));
  EXPECT_TRUE(std::isnan(score.recall()));
  score.wrong = 2;
  EXPECT_EQ(score.precision(), 0.0);
  EXPECT_TRUE(std::isnan(score.recall()));
  EXPECT_EQ(nlohmann::json(score.recall()).dump(), "null");
}

// Computed by hand: of four detections with probability 0.55, two are true (error 0.05). The one
// detection with probability 0.9 is true (error 0.1). The result is (4 * 0.05 + 0.1) / 5.
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
