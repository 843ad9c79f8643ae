#include "speedmap/property_map/mixture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace roadbook {

void mixture_posterior(double y,
                       std::span<const double> weights,
                       std::span<const double> shares,
                       std::span<const NormalGamma> classes,
                       const MixtureOptions& options,
                       PropertyMixture& result) {
  const std::size_t K = classes.size();
  result.log_c.resize(K);
  result.q.assign(K, 0.0);
  result.rho.resize(weights.size() * K);
  for (std::size_t j = 0; j < K; ++j)
    result.log_c[j] = log_marginal(classes[j], y, options.literal_root);

  // M relative to the class that explains y best, so that the exponentials neither vanish nor
  // burst.
  const double top = *std::max_element(result.log_c.begin(), result.log_c.end());
  double M = 0.0;
  for (std::size_t j = 0; j < K; ++j) {
    const double c = std::exp(result.log_c[j] - top);
    for (std::size_t l = 0; l < weights.size(); ++l) {
      const double term = weights[l] * shares[l * K + j] * c;
      result.rho[l * K + j] = term;
      M += term;
    }
  }
  // With shares that are numerically 0 where the only good class stands, M may be 0 against `top`.
  const double log_in = M > 0.0 ? top + std::log(M) : -std::numeric_limits<double>::infinity();
  result.inlier = 1.0;
  result.log_evidence = log_in;
  if (options.outlier_weight > 0.0) {
    const double a = log_in + std::log1p(-options.outlier_weight);
    const double b = std::log(options.outlier_weight * options.outlier_density);
    const double high = std::max(a, b);
    result.log_evidence = high + std::log(std::exp(a - high) + std::exp(b - high));
    result.inlier = std::exp(a - result.log_evidence);
  }
  const double scale = M > 0.0 ? result.inlier / M : 0.0;
  for (std::size_t l = 0; l < weights.size(); ++l)
    for (std::size_t j = 0; j < K; ++j) result.q[j] += (result.rho[l * K + j] *= scale);
  for (double& q : result.q) q = std::min(q, 1.0);
}

}  // namespace roadbook
