#include "speedmap/property_map/projection.hpp"

#include <cmath>

namespace roadbook {
namespace {

// Prior and posterior of the class and their weights p and q.
struct Mixture {
  NormalGamma a, b;
  double p, q;
  double delta;  ///< mu_b - mu_a
};

NormalGamma predictive(const Mixture& m) {
  // All in sums of positive terms: no cancellation for any q.
  const double Q_a = m.a.expected_variance();
  const double Q_b = m.b.expected_variance();
  const double x = m.b.beta / m.a.beta;
  const double excess =
      m.p * m.p / (m.a.alpha - 1.0) + m.q * m.q / (m.b.alpha - 1.0) +
      m.p * m.q * (m.a.alpha * x / (m.b.alpha - 1.0) + m.b.alpha / ((m.a.alpha - 1.0) * x) - 2.0);
  NormalGamma result;
  const double Q = m.p * Q_a + m.q * Q_b;
  result.mu = m.a.mu + m.q * m.delta;
  result.lambda =
      Q / (m.p * Q_a / m.a.lambda + m.q * Q_b / m.b.lambda + m.p * m.q * m.delta * m.delta);
  result.alpha = 1.0 + 1.0 / excess;
  result.beta = Q / excess;
  return result;
}

// E[m tau] and E[m^2 tau] give mu and lambda of both the natural and the KL projection.
void match_precision_weighted_mean(const Mixture& m, NormalGamma& result) {
  const double w_a = m.p * m.a.alpha / m.a.beta;
  const double w_b = m.q * m.b.alpha / m.b.beta;
  result.mu = m.a.mu + m.delta * w_b / (w_a + w_b);
  result.lambda =
      1.0 / (m.p / m.a.lambda + m.q / m.b.lambda + m.delta * m.delta * w_a * w_b / (w_a + w_b));
}

void match_precision(const Mixture& m, NormalGamma& result) {
  const double T_a = m.a.alpha / m.a.beta;
  const double T_b = m.b.alpha / m.b.beta;
  const double T = m.p * T_a + m.q * T_b;
  const double variance =
      m.p * T_a / m.a.beta + m.q * T_b / m.b.beta + m.p * m.q * (T_a - T_b) * (T_a - T_b);
  result.alpha = T * T / variance;
  result.beta = T / variance;
}

NormalGamma natural(const Mixture& m) {
  NormalGamma result;
  match_precision_weighted_mean(m, result);
  match_precision(m, result);
  return result;
}

// Root of log(alpha) - digamma(alpha) = gap by Newton in log(alpha): the left side is convex and
// falls from infinity to 0, and 1 / (2 alpha) < left side < 1 / alpha brackets the start.
double shape_of_gap(double gap) {
  double alpha = 0.5 / gap * (1.0 + std::sqrt(1.0 + 4.0 * gap / 3.0)) / 2.0;
  for (int i = 0; i < 50; ++i) {
    const double f = std::log(alpha) - digamma(alpha) - gap;
    const double slope = 1.0 - alpha * trigamma(alpha);  // with respect to log(alpha)
    const double step = f / slope;
    alpha *= std::exp(-step);
    if (std::abs(step) < 1e-15) break;
  }
  return alpha;
}

NormalGamma nearest_in_kl(const Mixture& m) {
  NormalGamma result;
  match_precision_weighted_mean(m, result);
  const double T = m.p * m.a.alpha / m.a.beta + m.q * m.b.alpha / m.b.beta;
  const double log_tau = m.p * (digamma(m.a.alpha) - std::log(m.a.beta)) +
                         m.q * (digamma(m.b.alpha) - std::log(m.b.beta));
  result.alpha = shape_of_gap(std::log(T) - log_tau);
  result.beta = result.alpha / T;
  return result;
}

NormalGamma printed(const Mixture& m) {
  NormalGamma result;
  const double T_a = m.a.alpha / m.a.beta;
  const double T_b = m.b.alpha / m.b.beta;
  match_precision(m, result);
  result.mu = m.a.mu + m.q * m.delta;
  // E[m^2 tau] - E[m]^2 E[tau] with the squares' difference factored: it may be negative, but that
  // is the formula's doing and not rounding's.
  result.lambda =
      1.0 / (m.p / m.a.lambda + m.q / m.b.lambda +
             m.p * m.q * m.delta * (T_b * (m.b.mu + result.mu) - T_a * (m.a.mu + result.mu)));
  return result;
}

double sum_of(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum;
}

// E[w] of the mixture and the variances it leaves, component by component, in positive terms (law
// of total variance): E[w^2] - E[w]^2 would cancel for large counts.
struct WeightMoments {
  double mean;
  double variance;
};

WeightMoments weight_moments(double a, double rho, double r, double A) {
  const double A1 = A + 1.0;
  const double u = a / A;
  const double shift = (rho - r * u) / A1;
  const double within =
      (1.0 - r) * u * (1.0 - u) / A1 +
      ((r - rho) * a * (A1 - a) + rho * (a + 1.0) * (A - a)) / (A1 * A1 * (A1 + 1.0));
  const double between = (rho * (1.0 - u) * (1.0 - u) + (r - rho) * u * u) / (A1 * A1);
  return {u + shift, within + between - shift * shift};
}

}  // namespace

NormalGamma project_mixture_unguarded(const NormalGamma& prior,
                                      double y,
                                      double q,
                                      NormalGammaProjection projection) {
  if (q <= 0.0) return prior;
  const NormalGamma posterior = conjugate_update(prior, y);
  const Mixture m{prior, posterior, 1.0 - q, q, posterior.mu - prior.mu};
  switch (projection) {
    case NormalGammaProjection::kPredictive:
      return predictive(m);
    case NormalGammaProjection::kNatural:
      return natural(m);
    case NormalGammaProjection::kKl:
      return nearest_in_kl(m);
    case NormalGammaProjection::kPrinted:
      return printed(m);
  }
  return prior;
}

std::optional<NormalGamma> project_mixture(const NormalGamma& prior,
                                           double y,
                                           double q,
                                           NormalGammaProjection projection) {
  const NormalGamma result = project_mixture_unguarded(prior, y, q, projection);
  if (!result.proper()) return std::nullopt;
  return result;
}

void project_dirichlet(std::span<double> a,
                       std::span<const double> rho,
                       DirichletProjection projection) {
  if (projection == DirichletProjection::kFractional) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] += rho[i];
    return;
  }
  const double A = sum_of(a);
  const double r = sum_of(rho);
  if (!(r > 0.0)) return;
  if (projection == DirichletProjection::kPrinted) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      const WeightMoments w = weight_moments(a[i], rho[i], r, A);
      a[i] = w.mean * (w.mean * (1.0 - w.mean) / w.variance - 1.0);
    }
    return;
  }
  double spread = 0.0;
  double variance = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const WeightMoments w = weight_moments(a[i], rho[i], r, A);
    spread += w.mean * (1.0 - w.mean);
    variance += w.variance;
  }
  const double S = spread / variance - 1.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    a[i] = S * (a[i] / A + (rho[i] - r * a[i] / A) / (A + 1.0));
}

}  // namespace roadbook
