#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "base/random.hpp"
#include "speedmap/property_map/mixture.hpp"
#include "speedmap/property_map/projection.hpp"

namespace roadbook {
namespace {

double student_by_quadrature(const NormalGamma& ng, double y) {
  // Integral over tau of N(y; mu, (1 + 1/lambda) / tau) Gamma(tau; alpha, beta), in log tau, by the
  // trapezoidal rule: spectrally accurate for this integrand.
  const double width = 1.0 + 1.0 / ng.lambda;
  double sum = 0.0;
  const double step = 0.01;
  for (double x = -40.0; x < 40.0; x += step) {
    const double log_tau = x;
    const double tau = std::exp(log_tau);
    const double offset = y - ng.mu;
    sum += step * std::exp(0.5 * log_tau - 0.5 * std::log(2.0 * M_PI * width) -
                           0.5 * offset * offset * tau / width + ng.alpha * std::log(ng.beta) -
                           std::lgamma(ng.alpha) + ng.alpha * log_tau - ng.beta * tau);
  }
  return sum;
}

TEST(NormalGamma, MarginalAgreesWithQuadratureAndThePrintedOneDoesNot) {
  for (const double alpha : {1.5, 3.0, 10.0, 29.9, 30.1, 100.0}) {
    const NormalGamma ng{0.7, 4.0, alpha, 0.01 * alpha};
    for (const double y : {0.2, 0.7, 0.95}) {
      EXPECT_NEAR(std::exp(log_marginal(ng, y)) / student_by_quadrature(ng, y), 1.0, 1e-10);
      // The paper prints the gamma ratio inside the root. Known ratio: sqrt of it.
      EXPECT_NEAR(log_marginal(ng, y, true) - log_marginal(ng, y),
                  -0.5 * (std::lgamma(alpha + 0.5) - std::lgamma(alpha)), 1e-11);
    }
  }
}

TEST(NormalGamma, GammaRatioIsSmoothAtLargeArguments) {
  // Gamma(x + 1) / Gamma(x) = x joins two half steps, whatever the series.
  for (double x = 20.0; x < 1e12; x *= 1.7)
    EXPECT_NEAR(log_gamma_ratio_half(x) + log_gamma_ratio_half(x + 0.5), std::log(x), 4e-14);
}

// Moments of (1 - q) prior + q posterior by their definitions.
TEST(Projection, PredictiveKeepsMeanVarianceAndExpectedVariance) {
  Random random(4);
  for (int i = 0; i < 1000; ++i) {
    const NormalGamma a{random.uniform(-1.0, 2.0), std::exp(random.uniform(-4.0, 6.0)),
                        1.0 + std::exp(random.uniform(-4.0, 6.0)),
                        std::exp(random.uniform(-8.0, 2.0))};
    const double y = random.uniform(-1.0, 2.0);
    const double q = random.uniform();
    const NormalGamma b = conjugate_update(a, y);
    const auto got = project_mixture(a, y, q, NormalGammaProjection::kPredictive);
    ASSERT_TRUE(got);
    const double mean = (1.0 - q) * a.mu + q * b.mu;
    const double spread = (1.0 - q) * (a.mean_variance() + std::pow(a.mu - mean, 2)) +
                          q * (b.mean_variance() + std::pow(b.mu - mean, 2));
    EXPECT_NEAR(got->mu, mean, 1e-12);
    EXPECT_NEAR(got->mean_variance() / spread, 1.0, 1e-9);
    EXPECT_NEAR(
        got->expected_variance() / ((1.0 - q) * a.expected_variance() + q * b.expected_variance()),
        1.0, 1e-9);
    EXPECT_NEAR(got->alpha / got->beta / ((1.0 - q) * a.alpha / a.beta + q * b.alpha / b.beta), 1.0,
                1e-9);
  }
}

TEST(Projection, AllButThePredictiveCanLeaveTheirFamilyAndSaySo) {
  Random random(5);
  std::map<NormalGammaProjection, int> improper;
  for (int i = 0; i < 20000; ++i) {
    const NormalGamma a{random.uniform(0.2, 1.0), std::exp(random.uniform(-1.0, 4.0)),
                        1.05 + std::exp(random.uniform(-3.0, 3.0)),
                        std::exp(random.uniform(-6.0, -1.0))};
    const double y = random.uniform(0.0, 1.5);
    const double q = random.uniform();
    for (const auto projection : {NormalGammaProjection::kPredictive,
                                  NormalGammaProjection::kNatural, NormalGammaProjection::kPrinted})
      if (!project_mixture(a, y, q, projection)) ++improper[projection];
  }
  EXPECT_EQ(improper[NormalGammaProjection::kPredictive], 0);
  EXPECT_GT(improper[NormalGammaProjection::kNatural], 0);
  EXPECT_GT(improper[NormalGammaProjection::kPrinted], 200);
}

// Importance sampling from the prior with the likelihood as weight, for three knots.
TEST(Mixture, ClassPosteriorAgreesWithMonteCarlo) {
  const std::vector<NormalGamma> classes = {{0.6, 4.0, 5.0, 0.03}, {0.9, 6.0, 4.0, 0.02}};
  const std::vector<std::vector<double>> a = {{1.0, 3.0}, {4.0, 2.0}, {2.0, 2.0}};
  const std::vector<double> I = {0.5, 0.3, 0.2};
  const double y = 0.72;
  std::vector<double> shares;
  for (const auto& row : a)
    for (const double x : row) shares.push_back(x / (row[0] + row[1]));
  PropertyMixture mixture;
  mixture_posterior(y, I, shares, classes, {}, mixture);

  Random random(6);
  const auto gamma = [&](double shape) {  // Marsaglia and Tsang, shape >= 1
    const double d = shape - 1.0 / 3.0;
    while (true) {
      const double x = random.normal();
      const double v = std::pow(1.0 + x / std::sqrt(9.0 * d), 3);
      if (v > 0.0 && std::log(1.0 - random.uniform()) < 0.5 * x * x + d - d * v + d * std::log(v))
        return d * v;
    }
  };
  const int samples = 400000;
  double total = 0.0;
  double square = 0.0;
  std::vector<double> w_mean(3, 0.0), m_mean(2, 0.0);
  for (int k = 0; k < samples; ++k) {
    double w[3], m[2], density[2];
    for (std::size_t l = 0; l < 3; ++l) {
      const double x = gamma(a[l][0]);
      w[l] = x / (x + gamma(a[l][1]));
    }
    for (std::size_t j = 0; j < 2; ++j) {
      const double tau = gamma(classes[j].alpha) / classes[j].beta;
      m[j] = classes[j].mu + random.normal() / std::sqrt(classes[j].lambda * tau);
      density[j] = std::sqrt(tau / (2.0 * M_PI)) * std::exp(-0.5 * tau * (y - m[j]) * (y - m[j]));
    }
    double p = 0.0;
    for (std::size_t l = 0; l < 3; ++l) p += I[l] * (w[l] * density[0] + (1.0 - w[l]) * density[1]);
    total += p;
    square += p * p;
    for (std::size_t l = 0; l < 3; ++l) w_mean[l] += p * w[l];
    for (std::size_t j = 0; j < 2; ++j) m_mean[j] += p * m[j];
  }
  const double effective = total * total / square;
  EXPECT_NEAR(total / samples / std::exp(mixture.log_evidence), 1.0, 4.0 / std::sqrt(effective));
  for (std::size_t l = 0; l < 3; ++l) {
    auto posterior = a[l];
    project_dirichlet(posterior, {&mixture.rho[2 * l], 2}, DirichletProjection::kTrace);
    // A share's standard deviation is below 0.3: 4 of its errors.
    EXPECT_NEAR(posterior[0] / (posterior[0] + posterior[1]), w_mean[l] / total,
                4.0 * 0.3 / std::sqrt(effective));
  }
  for (std::size_t j = 0; j < 2; ++j) {
    const auto posterior =
        project_mixture(classes[j], y, mixture.q[j], NormalGammaProjection::kPredictive);
    ASSERT_TRUE(posterior);
    EXPECT_NEAR(posterior->mu, m_mean[j] / total, 4.0 * 0.1 / std::sqrt(effective));
  }
}

}  // namespace
}  // namespace roadbook
