#include "speedmap/property_map/normal_gamma.hpp"

#include <boost/math/special_functions/digamma.hpp>
#include <boost/math/special_functions/trigamma.hpp>
#include <cmath>
#include <numbers>

#include "base/error.hpp"

namespace roadbook {
namespace {

// Boost computes in long double unless told otherwise, which takes several times as long.
using InDouble = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

}  // namespace

bool NormalGamma::proper() const {
  return std::isfinite(mu) && std::isfinite(lambda) && std::isfinite(alpha) &&
         std::isfinite(beta) && lambda > 0.0 && alpha > 1.0 && beta > 0.0;
}

void NormalGamma::check(const std::string& name) const {
  const auto require = [&](bool good, const char* field, double got, const char* want) {
    if (!good) throw InvalidOption(name + "." + field, std::to_string(got), want);
  };
  require(std::isfinite(mu), "mu", mu, "a finite number");
  require(std::isfinite(lambda) && lambda > 0.0, "lambda", lambda, "a number above 0");
  require(std::isfinite(alpha) && alpha > 1.0, "alpha", alpha, "a number above 1");
  require(std::isfinite(beta) && beta > 0.0, "beta", beta, "a number above 0");
}

NormalGamma conjugate_update(const NormalGamma& prior, double y) {
  const double delta = y - prior.mu;
  NormalGamma posterior;
  posterior.mu = prior.mu + delta / (prior.lambda + 1.0);
  posterior.lambda = prior.lambda + 1.0;
  posterior.alpha = prior.alpha + 0.5;
  posterior.beta = prior.beta + 0.5 * prior.lambda / (prior.lambda + 1.0) * delta * delta;
  return posterior;
}

double log_gamma_ratio_half(double x) {
  if (x < 30.0) return std::lgamma(x + 0.5) - std::lgamma(x);
  // Asymptotic series of Gamma(x + 1/2) / Gamma(x) in 1 / x; the first term left out is below
  // 1e-17.
  const double r = 1.0 / x;
  const double r2 = r * r;
  return 0.5 * std::log(x) -
         r * (1.0 / 8.0 - r2 * (1.0 / 192.0 -
                                r2 * (1.0 / 640.0 - r2 * (17.0 / 14336.0 - r2 * 31.0 / 18432.0))));
}

double log_marginal(const NormalGamma& prior, double y, bool literal_root) {
  const double delta = y - prior.mu;
  const double z = prior.lambda / (prior.lambda + 1.0) * delta * delta / (2.0 * prior.beta);
  const double ratio = log_gamma_ratio_half(prior.alpha) * (literal_root ? 0.5 : 1.0);
  return -0.5 * std::log(2.0 * std::numbers::pi) - 0.5 * std::log1p(1.0 / prior.lambda) + ratio -
         0.5 * std::log(prior.beta) - (prior.alpha + 0.5) * std::log1p(z);
}

double digamma(double x) { return boost::math::digamma(x, InDouble()); }

double trigamma(double x) { return boost::math::trigamma(x, InDouble()); }

}  // namespace roadbook
