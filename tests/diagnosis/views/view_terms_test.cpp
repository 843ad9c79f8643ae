#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/random.hpp"
#include "diagnosis/views/view_evidence.hpp"
#include "diagnosis/views/view_saturation.hpp"
#include "diagnosis/views/wheel_variations.hpp"

namespace roadbook {
namespace {

Candidate candidate_named(const std::string& name) {
  Candidate candidate;
  candidate.name = name;
  return candidate;
}

TEST(WheelVariations, AreOfTheColumnOfAWheelEffectAndOfNoOther) {
  std::set<std::string> covariates;
  for (const Candidate& term : wheel_variations(candidate_named("wheels0.track_width"))) {
    EXPECT_EQ(term.hook, "wheels0.track_width");
    EXPECT_EQ(term.name, "wheels0.track_width ~ " + term.covariate);
    EXPECT_TRUE(covariates.insert(term.covariate).second);
  }
  EXPECT_FALSE(covariates.empty());
  // A radius that grows with the speed is an effect of its own.
  for (const Candidate& term : wheel_variations(candidate_named("wheels0.radius_speed")))
    EXPECT_NE(term.covariate, "speed");
  EXPECT_TRUE(wheel_variations(candidate_named("gyro0.bias")).empty());
}

// A plot of evidence has the covariate of the cause as its axis.
TEST(ViewEvidence, IsPlottedOverTheCovariateOfTheCause) {
  Candidate cause;
  cause.kind = CandidateKind::kGrammar;
  for (const auto& [covariate, axis] : {std::pair{"speed", "speed [m/s]"},
                                        {"turn rate", "turn rate [rad/s]"},
                                        {"acceleration", "acceleration [m/s^2]"},
                                        {"time", "time [s]"}}) {
    cause.covariate = covariate;
    EXPECT_EQ(view_evidence({}, {{"wheels0", "forward"}}, cause, {}, {}).covariate, axis);
  }
}

// Residuals of three times the stated noise, of which the fit took a fifth of the variance.
TEST(RenewNoise, TheScaleOfEachChannelIsThatOfItsResiduals) {
  constexpr std::size_t kCount = 4000;
  const ViewChannels channels{0};
  Random random(2, "residuals");
  Saturated left;
  left.squares.resize(channels.size());
  left.redundancy.assign(channels.size(), 0.8 * kCount);
  for (const std::size_t channel : {channels.motion(1), channels.ground()})
    for (std::size_t i = 0; i < kCount; ++i)
      left.squares[channel].push_back(0.8 * std::pow(3.0 * random.normal(), 2));
  ViewNoise noise;
  std::vector<double> freedom;
  renew_noise(left, {}, noise, freedom);
  // Relative standard error of a median of absolute values: 1.17 / sqrt(n).
  const double error = 1.17 / std::sqrt(1.0 * kCount);
  EXPECT_NEAR(noise.motion[1], 3.0, 3.0 * 4.0 * error);
  EXPECT_NEAR(noise.ground_m, 3.0 * 0.02, 3.0 * 0.02 * 4.0 * error);
  EXPECT_EQ(noise.motion[0], 1.0);
  for (double& square : left.squares[channels.ground()]) square = 0.0;
  for (int round = 0; round < 3; ++round) renew_noise(left, {}, noise, freedom);
  EXPECT_EQ(noise.ground_m, 5e-4) << "no ground is known more exactly";
}

}  // namespace
}  // namespace roadbook
