#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/random.hpp"
#include "sensors/friction.hpp"
#include "sensors/range.hpp"
#include "sensors/stream_noise.hpp"

namespace roadbook {
namespace {

BeamMixture mixture() {
  BeamMixture m;
  m.shortened = 0.2;
  m.maximum = 0.05;
  m.crosstalk = 0.1;
  m.short_rate_per_m = 0.4;
  return m;
}

// Thrun et al., equations 6.4 to 6.11: each part is a density, whose integral is 1.
TEST(BeamModel, EveryPartIntegratesToOne) {
  constexpr double kMax = 8.0, kExpected = 5.0, kSigma = 0.05, kStep = 1e-4;
  BeamDensity sum;
  for (double z = 0.5 * kStep; z < kMax; z += kStep) {
    const BeamDensity d = beam_density(z, kExpected, kSigma, 0.4, kMax);
    sum.hit += kStep * d.hit;
    sum.shortened += kStep * d.shortened;
    sum.crosstalk += kStep * d.crosstalk;
    EXPECT_EQ(d.maximum, 0.0);
  }
  EXPECT_NEAR(sum.hit, 1.0, 1e-6);
  EXPECT_NEAR(sum.shortened, 1.0, 1e-4);
  EXPECT_NEAR(sum.crosstalk, 1.0, 1e-6);
  EXPECT_EQ(beam_density(kMax, kExpected, kSigma, 0.4, kMax).maximum, 1.0);
}

// Drawn readings against the distribution that the density has: Kolmogorov and Smirnov.
TEST(BeamModel, ReadingsAreDistributedAsTheDensitySays) {
  RangeModel model;
  model.max_m = 8.0;
  model.sigma_m = 0.05;
  const BeamMixture m = mixture();
  Random random(7);
  constexpr int kReadings = 20000;
  std::vector<double> read;
  for (int i = 0; i < kReadings; ++i)
    read.push_back(
        predict_range(model, m, 5.0, random.uniform(), random.uniform(), random.normal()));
  std::sort(read.begin(), read.end());
  constexpr double kStep = 1e-3;
  double below = 0.0, worst = 0.0;
  std::size_t at = 0;
  for (double z = 0.0; z < model.max_m - kStep; z += kStep) {
    below += kStep * beam_density(z + 0.5 * kStep, 5.0, 0.05, 0.4, 8.0).of(m);
    while (at < read.size() && read[at] <= z + kStep) ++at;
    worst = std::max(worst, std::abs(below - static_cast<double>(at) / kReadings));
  }
  EXPECT_LT(worst, 1.95 / std::sqrt(kReadings));  // p = 0.001
  EXPECT_NEAR(below, 1.0 - m.maximum, 1e-4);
}

TEST(FrictionModel, ABiasOfSlipIsRelativeToTheFrictionAtFullUse) {
  FrictionImperfections<double> off;
  off.slip_bias = 0.1;
  FrictionMoment at;
  at.in_use = 0.6;  // all that a friction of 0.6 can hold
  EXPECT_NEAR(predict_friction(off, 0.6, at), 0.6 * 1.1, 1e-15);
  at.in_use = 0.3;
  EXPECT_NEAR(predict_friction(off, 0.6, at), 0.6 * 1.05, 1e-15);
}

TEST(FrictionModel, OnlyWetGroundDries) {
  FrictionImperfections<double> off;
  off.drying = 1e-4;
  FrictionMoment at;
  at.elapsed_s = 600.0;
  EXPECT_EQ(predict_friction(off, 0.4, at), 0.4);
  at.wet = true;
  EXPECT_NEAR(predict_friction(off, 0.4, at), 0.46, 1e-15);
}

TEST(StreamNoise, HasTheVarianceCorrelationAndOutliersThatAreAskedFor) {
  const auto draw = [](const EffectSizes& sizes, double speed) {
    StreamNoise noise(sizes, "imu0");
    Random random(5);
    std::vector<double> values;
    for (int i = 0; i < 100000; ++i) values.push_back(noise.next(random, speed, 0.2));
    return values;
  };
  const auto product = [](const std::vector<double>& v, std::size_t lag) {
    double sum = 0.0;
    for (std::size_t i = lag; i < v.size(); ++i) sum += v[i] * v[i - lag];
    return sum / static_cast<double>(v.size());
  };
  // Four standard errors of each: sqrt(2 / n) of a variance, about 1 / sqrt(n) of a correlation.
  EXPECT_NEAR(product(draw({}, 2.0), 0), 1.0, 0.018);
  EXPECT_NEAR(product(draw({{"imu0.variance(speed)", 0.5}}, 4.0), 0), std::exp(1.0), 0.05);
  const auto correlated = draw({{"imu0.correlation", 0.6}}, 2.0);
  EXPECT_NEAR(product(correlated, 0), 1.0, 0.03);
  EXPECT_NEAR(product(correlated, 1), 0.6, 0.03);
  EXPECT_NEAR(product(draw({{"imu0.outliers", 0.05}}, 2.0), 0), 0.95 + 0.05 * 100.0, 0.5);
  EXPECT_EQ(draw({{"wheels0.outliers", 0.05}}, 2.0), draw({}, 2.0));
}

}  // namespace
}  // namespace roadbook
