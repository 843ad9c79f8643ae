#include "sensors/range/range_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/random.hpp"
#include "sensors/range/range_scores.hpp"

namespace roadbook {
namespace {

constexpr double kMax_m = 20.0;
constexpr double kHitSigma_m = 0.05;

BeamMixture true_shares() {
  BeamMixture m;
  m.shortened = 0.10;
  m.maximum = 0.05;
  m.crosstalk = 0.05;
  m.short_rate_per_m = 0.5;
  return m;
}

// Beams of the simulation's own model, which meet a surface between 2 and 15 m.
std::vector<BeamSample> beams_of(std::uint64_t seed, int count, const BeamMixture& shares) {
  Random random(seed, "beams");
  RangeModel model;
  model.max_m = kMax_m;
  model.sigma_m = kHitSigma_m;
  std::vector<BeamSample> samples;
  for (int i = 0; i < count; ++i) {
    BeamSample s{0.1 * (i / 40), 0.0, random.uniform(2.0, 15.0)};
    s.read_m = predict_range(model, shares, s.expected_m, random.uniform(), random.uniform(),
                             random.normal());
    samples.push_back(s);
  }
  return samples;
}

RangeFitOptions document_fit(int starts = 1) {
  RangeFitOptions options;
  options.parts = {true, true, true, false};
  options.wide = false;
  options.starts = starts;
  options.to_the_maximum = true;
  return options;
}

// Document 001's mixture: shares within 0.01, noise within 3 %, 10,000 beams, ten of ten seeds. The
// simulation draws with `predict_range`, the fit evaluates `beam_density`.
TEST(RangeFit, FindsTheMixtureThatTheSimulationDrewFrom) {
  const BeamMixture truth = true_shares();
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    const RangeMixture m = fit_range_mixture(beams_of(seed, 10000, truth), kMax_m, document_fit());
    EXPECT_NEAR(m.hit(), truth.hit(), 0.01);
    EXPECT_NEAR(m.share[kShort], truth.shortened, 0.01);
    EXPECT_NEAR(m.share[kMaximum], truth.maximum, 0.01);
    EXPECT_NEAR(m.share[kCrosstalk], truth.crosstalk, 0.01);
    EXPECT_EQ(m.share[kOutliers], 0.0);
    EXPECT_NEAR(m.sigma_m / kHitSigma_m, 1.0, 0.03);
  }
}

// 120 draws of each of five parameters: the 95 % interval holds in 91 to 99 % (three standard
// deviations of a binomial share). `evaluate occupancy` draws 1,000.
TEST(RangeFit, IntervalsHoldAsOftenAsTheySay) {
  const BeamMixture truth = true_shares();
  int held = 0, asked = 0;
  const auto ask = [&](double value, double sigma, double true_value) {
    held += std::abs(value - true_value) < 1.96 * sigma ? 1 : 0;
    ++asked;
  };
  for (std::uint64_t seed = 100; seed < 220; ++seed) {
    const RangeMixture m = fit_range_mixture(beams_of(seed, 3000, truth), kMax_m, document_fit());
    ask(m.hit(), m.sigma_hit, truth.hit());
    ask(m.share[kShort], m.sigma[kShort], truth.shortened);
    ask(m.share[kMaximum], m.sigma[kMaximum], truth.maximum);
    ask(m.sigma_m, m.sigma_sigma_m, kHitSigma_m);
    ask(m.short_rate_per_m, m.sigma_rate, truth.short_rate_per_m);
  }
  EXPECT_GT(held, 0.91 * asked);
  EXPECT_LT(held, 0.99 * asked);
}

TEST(RangeFit, APartThatIsOffStaysZeroAndOthersTakeItsReadings) {
  RangeFitOptions options = document_fit();
  options.parts[kCrosstalk] = false;
  const RangeMixture m = fit_range_mixture(beams_of(3, 5000, true_shares()), kMax_m, options);
  EXPECT_EQ(m.share[kCrosstalk], 0.0);
  EXPECT_EQ(m.sigma[kCrosstalk], 0.0);
  EXPECT_GT(m.share[kShort], 0.11);
}

// Noise of 0.4 m: from 0.02 m alone, the hits are taken for crosstalk and short readings.
TEST(RangeFit, SeveralStartsReachALikelihoodNoLowerThanOne) {
  RangeModel model;
  model.max_m = kMax_m;
  model.sigma_m = 0.4;
  Random random(5);
  std::vector<BeamSample> samples;
  for (int i = 0; i < 3000; ++i) {
    BeamSample s{0.01 * i, 0.0, random.uniform(2.0, 15.0)};
    s.read_m = predict_range(model, true_shares(), s.expected_m, random.uniform(), random.uniform(),
                             random.normal());
    samples.push_back(s);
  }
  const RangeMixture one = fit_range_mixture(samples, kMax_m, document_fit(1));
  const RangeMixture many = fit_range_mixture(samples, kMax_m, document_fit(5));
  EXPECT_GE(many.log_likelihood, one.log_likelihood - 1e-6);
  EXPECT_NEAR(many.sigma_m, 0.4, 0.03);
}

// Every score against a central difference of the log likelihood.
TEST(RangeFit, ScoresAreDerivativesOfTheLikelihood) {
  auto samples = beams_of(9, 400, true_shares());
  // Surfaces so near to the maximum that noise reads the maximum, one of them beyond.
  for (const double expected_m : {kMax_m - 0.10, kMax_m - 0.03, kMax_m})
    samples.push_back({0.5, kMax_m, expected_m});
  RangeMixture m = mixture_of(true_shares(), 0.06);
  m.wide = 0.1;
  m.share[kOutliers] = 0.02;
  const std::vector<std::size_t> which{kShort,     kMaximum,  kCrosstalk, kOutliers,
                                       kWideShare, kLogSigma, kLogRate};
  const auto value = [&](std::size_t parameter, double by) {
    RangeMixture other = m;
    if (parameter < kRangeParts) other.share[parameter] += by;
    if (parameter == kWideShare) other.wide += by;
    if (parameter == kLogSigma) other.sigma_m *= std::exp(by);
    if (parameter == kLogRate) other.short_rate_per_m *= std::exp(by);
    return mean_log_density(samples, kMax_m, other) * static_cast<double>(samples.size());
  };
  std::vector<RangeDensities> densities;
  for (const BeamSample& s : samples)
    densities.push_back(range_densities(s.read_m, s.expected_m, m, kMax_m));
  const RangeScores scores = range_scores(samples, densities, which, kMax_m, 1.0, m);
  for (std::size_t k = 0; k < which.size(); ++k) {
    const double numeric = (value(which[k], 1e-5) - value(which[k], -1e-5)) / 2e-5;
    // 1e-4 of wide hits' weight is in the uniform part, which the score of `wide` leaves out.
    EXPECT_NEAR(scores.gradient[static_cast<Eigen::Index>(k)], numeric,
                2e-4 * (1.0 + std::abs(numeric)))
        << which[k];
  }
}

}  // namespace
}  // namespace roadbook
