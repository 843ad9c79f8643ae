#include "speedmap/property_map/class_refresh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "base/error.hpp"

namespace roadbook {
namespace {

// What was measured, with the sensor's own noise: `sigmas` is empty or one for each value.
struct Values {
  std::span<const double> y;
  std::span<const double> sigmas;
  [[nodiscard]] std::size_t size() const { return y.size(); }
  [[nodiscard]] double noise(std::size_t k) const {
    return sigmas.empty() ? 0.0 : sigmas[k] * sigmas[k];
  }
};

// Sums of the soft counts of one class, each value worth as much as noisy_value.hpp says: n for the
// mean, n_scatter for the variance, the mean of y, the sum of (y - mean)^2 beyond the noise.
struct Count {
  double n = 0.0;
  double n_scatter = 0.0;
  double mean = 0.0;
  double scatter = 0.0;
};

double worth(const NormalGamma& ng, double noise) {
  if (noise == 0.0) return 1.0;
  const double Q = ng.expected_variance();
  return Q / (Q + noise);
}

std::vector<Count> count(const Values& values,
                         std::span<const double> q,
                         const std::vector<NormalGamma>& classes) {
  const std::size_t K = classes.size();
  std::vector<Count> counts(K);
  for (std::size_t k = 0; k < values.size(); ++k)
    for (std::size_t i = 0; i < K; ++i) {
      const double w = worth(classes[i], values.noise(k));
      counts[i].n += q[k * K + i] * w;
      counts[i].n_scatter += q[k * K + i] * w * w;
      counts[i].mean += q[k * K + i] * w * values.y[k];
    }
  for (Count& c : counts)
    if (c.n > 0.0) c.mean /= c.n;
  for (std::size_t k = 0; k < values.size(); ++k)
    for (std::size_t i = 0; i < K; ++i) {
      const double w = worth(classes[i], values.noise(k));
      const double offset = values.y[k] - counts[i].mean;
      counts[i].scatter += q[k * K + i] * w * w * (offset * offset - values.noise(k));
    }
  for (Count& c : counts) c.scatter = std::max(c.scatter, 0.0);
  return counts;
}

NormalGamma posterior(const NormalGamma& prior, const Count& c) {
  NormalGamma result;
  const double offset = c.mean - prior.mu;
  result.lambda = prior.lambda + c.n;
  result.mu = prior.mu + offset * c.n / result.lambda;
  result.alpha = prior.alpha + 0.5 * c.n_scatter;
  result.beta =
      prior.beta + 0.5 * c.scatter + 0.5 * prior.lambda * c.n / result.lambda * offset * offset;
  return result;
}

// Expected log density of a value under a class, without the constant.
double log_density(const NormalGamma& ng, double level, double y, double noise) {
  const double offset = y - ng.mu;
  if (noise == 0.0) return level - 0.5 * ng.alpha / ng.beta * offset * offset;
  const double variance = ng.beta / ng.alpha + noise;
  return -0.5 * std::log(variance) - 0.5 * (offset * offset + ng.mean_variance()) / variance;
}

// q of every value from the classes' expected log densities.
void judge(const Values& values,
           std::span<const double> class_weights,
           const std::vector<NormalGamma>& classes,
           const ClassRefreshOptions& options,
           std::vector<double>& q) {
  const std::size_t K = classes.size();
  std::vector<double> level(K);
  for (std::size_t i = 0; i < K; ++i)
    level[i] =
        0.5 * (digamma(classes[i].alpha) - std::log(classes[i].beta) - 1.0 / classes[i].lambda);
  const double in = 1.0 - options.outlier_weight;
  const double out =
      options.outlier_weight * options.outlier_density * std::sqrt(2.0 * std::numbers::pi);
  for (std::size_t k = 0; k < values.size(); ++k) {
    double top = -1e300;
    for (std::size_t i = 0; i < K; ++i) {
      q[k * K + i] = log_density(classes[i], level[i], values.y[k], values.noise(k));
      top = std::max(top, q[k * K + i]);
    }
    double sum = out > 0.0 ? out * std::exp(-top) : 0.0;
    for (std::size_t i = 0; i < K; ++i)
      sum += q[k * K + i] = in * class_weights[k * K + i] * std::exp(q[k * K + i] - top);
    const double scale = sum > 0.0 ? 1.0 / sum : 0.0;
    for (std::size_t i = 0; i < K; ++i) q[k * K + i] *= scale;
  }
}

}  // namespace

void ClassRefreshOptions::check() const {
  if (sweeps < 1) throw InvalidOption("sweeps", std::to_string(sweeps), "1 or more");
  if (!(start_sharpness >= 1.0 && start_sharpness <= 100.0))
    throw InvalidOption("start_sharpness", std::to_string(start_sharpness), "1 to 100");
  if (!(outlier_weight >= 0.0 && outlier_weight < 1.0))
    throw InvalidOption("outlier_weight", std::to_string(outlier_weight), "a number in [0, 1)");
}

std::vector<NormalGamma> refresh_classes(std::span<const double> values,
                                         std::span<const double> class_weights,
                                         std::span<const NormalGamma> prior,
                                         const ClassRefreshOptions& options,
                                         std::span<const double> sigmas) {
  options.check();
  if (!sigmas.empty() && sigmas.size() != values.size())
    throw InvalidOption("sigmas", std::to_string(sigmas.size()), std::to_string(values.size()));
  const Values measured{values, sigmas};
  const std::size_t K = prior.size();
  if (class_weights.size() != values.size() * K)
    throw InvalidOption("class_weights", std::to_string(class_weights.size()) + " numbers",
                        std::to_string(values.size() * K));
  std::vector<double> q(class_weights.size());
  for (std::size_t k = 0; k < values.size(); ++k) {
    double sum = 0.0;
    for (std::size_t i = k * K; i < (k + 1) * K; ++i)
      sum += q[i] = std::pow(class_weights[i], options.start_sharpness);
    for (std::size_t i = k * K; i < (k + 1) * K; ++i) q[i] *= sum > 0.0 ? 1.0 / sum : 0.0;
  }
  std::vector<NormalGamma> classes(prior.begin(), prior.end());
  for (int sweep = 0; sweep < options.sweeps; ++sweep) {
    const std::vector<Count> counts = count(measured, q, classes);
    for (std::size_t i = 0; i < K; ++i) classes[i] = posterior(prior[i], counts[i]);
    if (sweep + 1 < options.sweeps) judge(measured, class_weights, classes, options, q);
  }
  return classes;
}

}  // namespace roadbook
