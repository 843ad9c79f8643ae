#pragma once

#include <string>

namespace roadbook {

/// Normal-gamma belief over mean m and precision tau of one class [SPM, section 2]:
/// tau ~ Gamma(alpha, beta), m ~ N(mu, 1 / (lambda tau)).
struct NormalGamma {
  double mu = 0.0;
  double lambda = 1.0;
  double alpha = 2.0;  ///< above 1, or the variance of a measurement would be infinite
  double beta = 1.0;

  /// E[1 / tau]: expected variance within the class.
  [[nodiscard]] double expected_variance() const { return beta / (alpha - 1.0); }
  /// Variance of the class mean m.
  [[nodiscard]] double mean_variance() const { return expected_variance() / lambda; }
  /// Variance of the next measurement of the class.
  [[nodiscard]] double predictive_variance() const {
    return expected_variance() * (1.0 + 1.0 / lambda);
  }
  /// Finite, lambda > 0, alpha > 1, beta > 0.
  [[nodiscard]] bool proper() const;
  /// Throws InvalidOption that names `name` unless proper.
  void check(const std::string& name) const;
};

/// Belief after a measurement that is known to be of this class [SPM, eq. 12a, 12b].
[[nodiscard]] NormalGamma conjugate_update(const NormalGamma& prior, double y);

/// Logarithm of the Student t density of the next measurement: c_j of [SPM, eq. 12c] with the gamma
/// ratio outside the root. `literal_root`: the printed formula with the ratio inside (too small by
/// about alpha^(1/4)).
[[nodiscard]] double log_marginal(const NormalGamma& prior, double y, bool literal_root = false);

/// log Gamma(x + 1/2) - log Gamma(x), without the cancellation of the difference at large x.
[[nodiscard]] double log_gamma_ratio_half(double x);
/// First and second derivative of log Gamma at x > 0.
[[nodiscard]] double digamma(double x);
[[nodiscard]] double trigamma(double x);

}  // namespace roadbook
