#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/error.hpp"
#include "speedmap/property_map/mixture.hpp"
#include "speedmap/property_map/noisy_value.hpp"
#include "speedmap/property_map/property_map.hpp"

namespace roadbook {
namespace {

// Forgetting: precision of the mean and of the variance shrink towards floors that keep the belief
// usable; the expected variance stays.
constexpr double kLeastLambda = 2.0;
constexpr double kLeastAlpha = 1.5;

void fade(NormalGamma& ng, double keep) {
  const double Q = ng.expected_variance();
  if (ng.lambda > kLeastLambda) ng.lambda = std::max(kLeastLambda, keep * ng.lambda);
  if (ng.alpha > kLeastAlpha) ng.alpha = std::max(kLeastAlpha, 1.0 + keep * (ng.alpha - 1.0));
  ng.beta = Q * (ng.alpha - 1.0);
}

}  // namespace

double PropertyMap::gate_evidence() const {
  double sum = 0.0;
  for (std::size_t n = 0; n < near_.size(); ++n)
    sum += near_.weights[n] * evidence_[static_cast<std::size_t>(near_.knots[n])];
  return sum;
}

PropertyUpdateResult PropertyMap::add_value(std::size_t property,
                                            const PathPlace& v,
                                            double y,
                                            double sigma) {
  ROADBOOK_ASSERT(property < properties_.size());
  const PropertyPrior& about = prior_.properties[property];
  if (!(y >= about.min && y <= about.max))
    throw BadInput(Problem{Severity::kError, "", 0, about.name, std::to_string(y),
                           std::to_string(about.min) + " to " + std::to_string(about.max)});
  if (!(std::isfinite(sigma) && sigma >= 0.0))
    throw BadInput(Problem{Severity::kError, "", 0, about.name + " sigma", std::to_string(sigma),
                           "0 or more"});
  PropertyUpdateResult result;
  interpolate(knots_, v, near_);
  if (!near_.covered()) return {PropertyUpdate::kUncovered, 0.0, 0.0};

  const std::size_t K = classes();
  thread_local std::vector<double> shares;
  thread_local PropertyMixture mixture;
  shares.resize(near_.size() * K);
  for (std::size_t n = 0; n < near_.size(); ++n)
    shares_of(static_cast<std::size_t>(near_.knots[n]), &shares[n * K]);
  const MixtureOptions mixture_options{options_.literal_root, options_.outlier_weight,
                                       1.0 / (about.max - about.min)};
  std::array<NormalGamma, kMaxPropertyClasses> seen;  // the classes as the sensor sees them
  for (std::size_t j = 0; j < K; ++j) seen[j] = as_sensed(properties_[property][j], sigma);
  mixture_posterior(y, near_.weights, shares, {seen.data(), K}, mixture_options, mixture);
  result.log_evidence = mixture.log_evidence;
  result.inlier = mixture.inlier;
  if (gate_evidence() < options_.gate_counts) {
    result.status = PropertyUpdate::kTooLittleEvidence;
    return result;
  }

  // Everything is computed before anything is changed: a rejected update leaves the map as it was.
  std::array<NormalGamma, kMaxPropertyClasses> updated;
  for (std::size_t j = 0; j < K; ++j) {
    NormalGamma prior = properties_[property][j];
    if (options_.half_life_values > 0.0)
      fade(prior, std::exp2(-mixture.q[j] / options_.half_life_values));
    auto projected =
        project_mixture(as_sensed(prior, sigma), y, mixture.q[j], options_.normal_gamma);
    if (projected && sigma > 0.0) projected = of_the_ground(prior, *projected, sigma);
    if (!projected) {
      result.status = PropertyUpdate::kRejected;
      return result;
    }
    updated[j] = *projected;
  }
  std::copy_n(updated.begin(), K, properties_[property].begin());

  for (std::size_t n = 0; n < near_.size(); ++n) {
    double* const belief = &belief_[static_cast<std::size_t>(near_.knots[n]) * K];
    double* const rho = &mixture.rho[n * K];
    if (options_.semantics == SemanticModel::kDiscrete) {
      // p(class i | y) = (1 - r) u_i + rho_i, exactly.
      double r = 0.0;
      for (std::size_t i = 0; i < K; ++i) r += rho[i];
      for (std::size_t i = 0; i < K; ++i) {
        const double p = (1.0 - r) * shares[n * K + i] + rho[i];
        belief[i] = std::log(std::max(p, std::numeric_limits<double>::min()));
      }
    } else if (options_.literal_counts) {
      for (std::size_t i = 0; i < K; ++i) belief[i] += near_.weights[n] * mixture.q[i];
    } else {
      project_dirichlet({belief, K}, {rho, K}, options_.dirichlet);
    }
  }
  return result;
}

void PropertyMap::forget(double seconds) {
  if (!(std::isfinite(seconds) && seconds >= 0.0))
    throw InvalidOption("seconds", std::to_string(seconds), "0 or more");
  if (options_.half_life_s > 0.0) {
    const double keep = std::exp2(-seconds / options_.half_life_s);
    for (auto& property : properties_)
      for (NormalGamma& ng : property) fade(ng, keep);
  }
  if (options_.knot_half_life_s > 0.0) {
    const double keep = std::exp2(-seconds / options_.knot_half_life_s);
    const std::size_t K = classes();
    const bool discrete = options_.semantics == SemanticModel::kDiscrete;
    double total = 0.0;
    for (const double a : prior_.counts) total += a;
    for (std::size_t l = 0; l < knots_.size(); ++l) {
      for (std::size_t i = 0; i < K; ++i) {
        const double a = prior_.counts[i];
        const double rest = discrete ? std::log(a / total) : a;
        belief_[l * K + i] = rest + keep * (belief_[l * K + i] - rest);
      }
      evidence_[l] *= keep;
    }
  }
}

}  // namespace roadbook
