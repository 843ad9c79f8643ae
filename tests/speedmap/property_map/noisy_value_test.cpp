#include "speedmap/property_map/noisy_value.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.hpp"
#include "base/random.hpp"
#include "speedmap/property_map/class_refresh.hpp"
#include "speedmap/property_map/property_mapper.hpp"
#include "tests/speedmap/small_property_map.hpp"

// Measurements that state their noise.

namespace roadbook {
namespace {

// With a variance known as well as certain, the update of the mean is Kalman's.
TEST(NoisyValue, WithAKnownVarianceTheMeanIsKalmans) {
  const double Q = 0.01;
  const double alpha = 1e7;
  for (const double sigma : {0.0, 0.03, 0.1, 0.5}) {
    NormalGamma ng{0.6, 2.0, alpha, Q * (alpha - 1.0)};
    double mean = 0.6;
    double variance = Q / 2.0;
    Random random(1, "kalman");
    for (int k = 0; k < 50; ++k) {
      const double y = 0.7 + random.normal(0.0, std::hypot(0.1, sigma));
      ng = of_the_ground(ng, conjugate_update(as_sensed(ng, sigma), y), sigma);
      const double gain = variance / (variance + Q + sigma * sigma);
      mean += gain * (y - mean);
      variance *= 1.0 - gain;
    }
    EXPECT_NEAR(ng.mu, mean, 1e-5) << sigma;
    EXPECT_NEAR(ng.mean_variance(), variance, 1e-4 * variance) << sigma;
  }
}

// Half of the readings come from a bad sensor that states its large sigma.
TEST(NoisyValue, ABadSensorThatSaysSoDoesNotSpoilAGoodOne) {
  double error_told = 0.0;
  double error_untold = 0.0;
  double scatter_told = 0.0;
  double scatter_untold = 0.0;
  const int runs = 40;
  for (std::uint64_t seed = 0; seed < runs; ++seed) {
    NormalGamma told{0.5, 0.1, 2.0, 0.01};
    NormalGamma untold = told;
    Random random(seed, "two sensors");
    for (int k = 0; k < 400; ++k) {
      const double sigma = k % 2 == 0 ? 0.02 : 0.3;
      const double y = 0.8 + random.normal(0.0, 0.05) + random.normal(0.0, sigma);
      told = of_the_ground(told, conjugate_update(as_sensed(told, sigma), y), sigma);
      untold = conjugate_update(untold, y);
      ASSERT_TRUE(told.proper());
    }
    error_told += std::abs(told.mu - 0.8) / runs;
    error_untold += std::abs(untold.mu - 0.8) / runs;
    scatter_told += std::sqrt(told.expected_variance()) / runs;
    scatter_untold += std::sqrt(untold.expected_variance()) / runs;
  }
  EXPECT_LT(error_told, 0.6 * error_untold);
  EXPECT_NEAR(scatter_told, 0.05, 0.01);
  EXPECT_GT(scatter_untold, 0.15);
}

TEST(NoisyValue, TheBatchRefreshWeighsLikewise) {
  Random random(3, "refresh");
  std::vector<double> values;
  std::vector<double> sigmas;
  std::vector<double> weights;
  for (int k = 0; k < 600; ++k) {
    const bool wet = k % 3 == 0;
    sigmas.push_back(k % 2 == 0 ? 0.02 : 0.25);
    values.push_back((wet ? 0.4 : 0.8) + random.normal(0.0, 0.04) +
                     random.normal(0.0, sigmas.back()));
    weights.push_back(wet ? 0.1 : 0.9);
    weights.push_back(wet ? 0.9 : 0.1);
  }
  const std::vector<NormalGamma> prior{{0.7, 0.1, 2.0, 0.01}, {0.5, 0.1, 2.0, 0.01}};
  const auto told = refresh_classes(values, weights, prior, {}, sigmas);
  EXPECT_NEAR(told[0].mu, 0.8, 0.012);
  EXPECT_NEAR(told[1].mu, 0.4, 0.015);
  EXPECT_NEAR(std::sqrt(told[0].expected_variance()), 0.04, 0.015);
  const std::vector<double> none(values.size(), 0.0);
  const auto plain = refresh_classes(values, weights, prior);
  const auto zero = refresh_classes(values, weights, prior, {}, none);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(plain[i].mu, zero[i].mu);
}

TEST(NoisyValue, AMillionValuesOfAnySigmaLeaveAProperMap) {
  PropertyMap map = test::small_map({});
  Random random(7, "million");
  for (int k = 0; k < 1'000'000; ++k) {
    const PathPlace v{random.uniform(0.0, 20.0), random.uniform(-3.0, 3.0)};
    if (k % 4 == 0) {
      (void)map.add_label(v, static_cast<int>(random.below(3)), random.uniform(0.0, 2.0));
      continue;
    }
    const double sigma = random.uniform() < 0.2 ? 0.0 : std::pow(10.0, random.uniform(-4.0, 2.0));
    (void)map.add_value(0, v, random.uniform(0.0, 1.5), sigma);
  }
  for (const NormalGamma& ng : map.property(0)) EXPECT_TRUE(ng.proper());
  for (std::size_t l = 0; l < map.knots().size(); ++l) {
    const PropertyMoments moments = map.knot_moments(0, l);
    EXPECT_TRUE(std::isfinite(moments.mean));
    EXPECT_GT(moments.variance, 0.0);
    for (const double a : map.belief(l)) EXPECT_GT(a, 0.0);
  }
}

TEST(NoisyValue, ANegativeSigmaOrAFrictionOfFortyLeavesTheMapAsItWas) {
  PropertyMap map = test::small_map({});
  for (int i = 0; i < 100; ++i) (void)map.add_label({10.0, 0.0}, 1);
  const auto before = map.moments(0, {10.0, 0.0});
  EXPECT_THROW((void)map.add_value(0, {10.0, 0.0}, 0.8, -0.1), BadInput);
  EXPECT_THROW((void)map.add_value(0, {10.0, 0.0}, 0.8, NAN), BadInput);
  EXPECT_THROW((void)map.add_value(0, {10.0, 0.0}, 40.0, 0.1), BadInput);
  EXPECT_THROW((void)map.add_label({10.0, 0.0}, 3), BadInput);
  EXPECT_EQ(map.moments(0, {10.0, 0.0})->mean, before->mean);
}

}  // namespace
}  // namespace roadbook
