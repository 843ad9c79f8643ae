#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "base/random.hpp"
#include "diagnosis/motion/motion_problem.hpp"
#include "diagnosis/numerics/outlier_share.hpp"
#include "diagnosis/streams/observe.hpp"
#include "tests/diagnosis/hidden_effects/injector.hpp"
#include "tests/diagnosis/hidden_effects/recorded_streams.hpp"

namespace roadbook {
namespace {

using test::Secret;

std::vector<NoiseCause> noise_of(std::uint64_t seed,
                                 const Secret& secret,
                                 const EffectSizes& known = {}) {
  test::HiddenDriveOptions options;
  options.seed = seed;
  options.secret = secret;
  const MotionProblem problem(observe(test::streams_of(test::record_drive(options))), known);
  return problem.noise_causes(problem.nominal());
}

std::set<std::string> names_of(const std::vector<NoiseCause>& causes) {
  std::set<std::string> names;
  for (const NoiseCause& c : causes) names.insert(c.effect);
  return names;
}

const std::vector<Secret>& pairs() {
  static const std::vector<Secret> kPairs{
      {{"imu0.outliers", 0.05}, {"imu0.variance(turn)", 6.0}},
      {{"imu0.outliers", 0.05}, {"imu0.correlation", 0.7}},
      {{"imu0.correlation", 0.6}, {"imu0.variance(turn)", 6.0}},
      {{"wheels0.outliers", 0.05}, {"wheels0.variance(turn)", 7.0}},
      {{"wheels0.outliers", 0.05}, {"wheels0.variance(speed)", 0.6}},
  };
  return kPairs;
}

// Outliers and growing variance are similar: of two noise effects both are named with their sizes.
TEST(NoisePairs, OfOneStreamAreBothNamed) {
  for (const Secret& hidden : pairs()) {
    const std::vector<NoiseCause> found = noise_of(2031, hidden);
    std::string said;
    for (const NoiseCause& c : found) said += c.effect + " ";
    EXPECT_EQ(found.size(), 2U) << said;
    for (const NoiseCause& c : found) {
      ASSERT_TRUE(hidden.contains(c.effect)) << said;
      EXPECT_NEAR(c.size, hidden.at(c.effect), 4.0 * c.sigma) << c.effect;
    }
  }
}

TEST(NoisePairs, OfWhichThereIsOneOnlyThatIsNamed) {
  std::set<std::string> tried;
  for (const Secret& both : pairs())
    for (const auto& [effect, size] : both) {
      if (!tried.insert(effect).second) continue;
      EXPECT_EQ(names_of(noise_of(2032, {{effect, size}})), std::set<std::string>{effect});
    }
  // With strongly correlated readings two or three give as much information as eight.
  for (const std::uint64_t seed : {2034U, 2035U, 2036U})
    EXPECT_EQ(names_of(noise_of(seed, {{"imu0.correlation", 0.9}})),
              std::set<std::string>{"imu0.correlation"});
}

// Noise effects of the model are not reported again; the other effect is still found.
TEST(NoisePairs, OfWhichTheModelHoldsOneLeaveTheOther) {
  for (const Secret& hidden : pairs()) {
    EXPECT_TRUE(noise_of(2033, hidden, EffectSizes(hidden.begin(), hidden.end())).empty());
    const auto& [effect, size] = *hidden.begin();
    EXPECT_EQ(names_of(noise_of(2033, hidden, {{effect, size}})),
              std::set<std::string>{hidden.rbegin()->first});
  }
  // The model holds a part of the share only.
  const auto beyond = noise_of(2033, {{"imu0.outliers", 0.08}}, {{"imu0.outliers", 0.02}});
  ASSERT_EQ(beyond.size(), 1U);
  EXPECT_NEAR(beyond[0].size, 0.06, 4.0 * beyond[0].sigma);
}

// Squares of eight readings about their line; a share of the readings has ten times the noise.
std::vector<double> squares_about_lines(Random& random, double sigma, double share, int looks) {
  const int n = 8;
  std::vector<double> squares;
  for (int k = 0; k < looks; ++k) {
    double s0 = 0.0, s1 = 0.0, st = 0.0, sq = 0.0, stt = 0.0;
    for (int i = 0; i < n; ++i) {
      const double t = i - 0.5 * (n - 1);
      const double e = sigma * random.normal() * (random.uniform() < share ? 10.0 : 1.0);
      s0 += 1.0;
      s1 += e;
      st += t * e;
      sq += e * e;
      stt += t * t;
    }
    squares.push_back(sq - s1 * s1 / s0 - st * st / stt);
  }
  return squares;
}

// Against simulated samples of two kinds with different scatter.
TEST(OutlierShare, IsThatOfTheReadingsWithAnIntervalThatHolds) {
  const int n = 8;
  std::vector<double> leverages;
  for (int i = 0; i < n; ++i)
    leverages.push_back(1.0 - 1.0 / n - std::pow(i - 0.5 * (n - 1), 2) * 12.0 / (n * (n * n - 1)));
  const LookShape shape{n - 2.0, double{n}, leverages};
  double squares = 0.0;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    Random random(seed, "outlier share");
    const double share = 0.01 * std::pow(10.0, random.uniform());
    const OutlierShare fit =
        fit_outlier_share({{shape, squares_about_lines(random, 0.3, share, 300)},
                           {shape, squares_about_lines(random, 2.0, share, 200)}});
    squares += std::pow((fit.share - share) / fit.sigma, 2);
  }
  // Chi-squared of 30: within 11.6 and 59.7 but for two in a thousand.
  EXPECT_GT(squares, 11.6);
  EXPECT_LT(squares, 59.7);
}

}  // namespace
}  // namespace roadbook
