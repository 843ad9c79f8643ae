#include "speedmap/property_map/property_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/error.hpp"
#include "base/require_option.hpp"

namespace roadbook {
namespace {

bool share(double x) { return x >= 0.0 && x < 1.0; }
bool half_life(double x) { return std::isfinite(x) && x >= 0.0; }

std::vector<double> confusion_or_identity(const std::vector<double>& confusion, std::size_t K) {
  if (!confusion.empty()) return confusion;
  std::vector<double> identity(K * K, 0.0);
  for (std::size_t i = 0; i < K; ++i) identity[i * K + i] = 1.0;
  return identity;
}

}  // namespace

void PropertyMapOptions::check(std::size_t classes) const {
  require_option(share(outlier_weight), "outlier_weight", outlier_weight, "a number in [0, 1)");
  require_option(gate_counts >= 0.0, "gate_counts", gate_counts, "0 or more");
  require_option(half_life(prior_mean_sigma), "prior_mean_sigma", prior_mean_sigma,
                 "0 (off) or more");
  require_option(std::isfinite(prior_alpha) && prior_alpha > 1.0, "prior_alpha", prior_alpha,
                 "a number above 1");
  require_option(half_life(half_life_values), "half_life_values", half_life_values,
                 "0 (never) or more");
  require_option(half_life(half_life_s), "half_life_s", half_life_s, "0 (never) or more");
  require_option(half_life(knot_half_life_s), "knot_half_life_s", knot_half_life_s,
                 "0 (never) or more");
  if (confusion.empty()) {
    if (semantics == SemanticModel::kDiscrete)
      throw InvalidOption("confusion", "nothing", "a matrix without zeros for discrete classes");
    return;
  }
  if (confusion.size() != classes * classes)
    throw InvalidOption("confusion", std::to_string(confusion.size()) + " numbers",
                        std::to_string(classes * classes));
  for (std::size_t i = 0; i < classes; ++i) {
    double sum = 0.0;
    for (std::size_t c = 0; c < classes; ++c) {
      const double p = confusion[i * classes + c];
      require_option(p >= 0.0 && p <= 1.0, "confusion", p, "probabilities");
      if (semantics == SemanticModel::kDiscrete)
        require_option(p > 0.0, "confusion", p, "no zeros for discrete classes");
      sum += p;
    }
    require_option(std::abs(sum - 1.0) < 1e-6, "confusion", sum, "rows that sum to 1");
  }
}

NormalGamma calibrated(NormalGamma ng, double mean_sigma, double alpha) {
  const double variance = ng.expected_variance();
  ng.alpha = std::min(ng.alpha, alpha);
  ng.beta = variance * (ng.alpha - 1.0);
  ng.lambda = std::min(ng.lambda, variance / (mean_sigma * mean_sigma));
  return ng;
}

void PropertyMapPrior::check() const {
  const std::size_t K = classes.size();
  if (K == 0 || K > kMaxPropertyClasses)
    throw InvalidOption("classes", std::to_string(K), "1 to 32");
  if (counts.size() != K)
    throw InvalidOption("counts", std::to_string(counts.size()), std::to_string(K));
  for (const double a : counts)
    require_option(std::isfinite(a) && a > 0.0, "counts", a, "numbers above 0");
  for (const PropertyPrior& property : properties) {
    require_option(std::isfinite(property.min), property.name + ".min", property.min,
                   "a finite number");
    require_option(std::isfinite(property.max) && property.max > property.min,
                   property.name + ".max", property.max, "more than min");
    if (property.classes.size() != K)
      throw InvalidOption(property.name, std::to_string(property.classes.size()) + " classes",
                          std::to_string(K));
    for (std::size_t i = 0; i < K; ++i) property.classes[i].check(property.name + "." + classes[i]);
  }
}

PropertyMap::PropertyMap(Knots knots, PropertyMapPrior prior, PropertyMapOptions options)
    : knots_(std::move(knots)), prior_(std::move(prior)), options_(std::move(options)) {
  prior_.check();
  options_.check(classes());
  if (options_.prior_mean_sigma > 0.0)
    for (PropertyPrior& property : prior_.properties)
      for (NormalGamma& ng : property.classes)
        ng = calibrated(ng, options_.prior_mean_sigma * (property.max - property.min),
                        options_.prior_alpha);
  confusion_ = confusion_or_identity(options_.confusion, classes());
  for (const double p : confusion_) log_confusion_.push_back(std::log(p));
  std::vector<double> start = prior_.counts;
  if (options_.semantics == SemanticModel::kDiscrete) {
    double sum = 0.0;
    for (const double a : start) sum += a;
    for (double& a : start) a = std::log(a / sum);
  }
  belief_.reserve(knots_.size() * classes());
  for (std::size_t l = 0; l < knots_.size(); ++l)
    belief_.insert(belief_.end(), start.begin(), start.end());
  evidence_.assign(knots_.size(), 0.0);
  for (const PropertyPrior& property : prior_.properties) properties_.push_back(property.classes);
}

void PropertyMap::shares_of(std::size_t knot, double* shares) const {
  const std::size_t K = classes();
  const double* belief = &belief_[knot * K];
  double sum = 0.0;
  if (options_.semantics == SemanticModel::kDiscrete) {
    const double top = *std::max_element(belief, belief + K);
    for (std::size_t i = 0; i < K; ++i) sum += shares[i] = std::exp(belief[i] - top);
  } else {
    for (std::size_t i = 0; i < K; ++i) sum += shares[i] = belief[i];
  }
  const double scale = 1.0 / sum;
  for (std::size_t i = 0; i < K; ++i) shares[i] *= scale;
}

void PropertyMap::knot_shares(std::size_t knot, std::span<double> shares) const {
  ROADBOOK_ASSERT(knot < knots_.size() && shares.size() == classes());
  shares_of(knot, shares.data());
}

void PropertyMap::set_belief(std::size_t knot, std::span<const double> belief, double evidence) {
  if (knot >= knots_.size() || belief.size() != classes())
    throw InvalidOption(
        "belief",
        "knot " + std::to_string(knot) + " with " + std::to_string(belief.size()) + " classes",
        std::to_string(knots_.size()) + " knots with " + std::to_string(classes()));
  const bool discrete = options_.semantics == SemanticModel::kDiscrete;
  for (const double a : belief)
    require_option(std::isfinite(a) && (discrete || a > 0.0), "belief", a,
                   "finite, counts above 0");
  require_option(std::isfinite(evidence) && evidence >= 0.0, "evidence", evidence, "0 or more");
  std::copy(belief.begin(), belief.end(), &belief_[knot * classes()]);
  evidence_[knot] = evidence;
}

void PropertyMap::set_property(std::size_t property, const std::vector<NormalGamma>& values) {
  if (property >= properties_.size() || values.size() != classes())
    throw InvalidOption("property", std::to_string(property), "one of the map's, with its classes");
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i].check(prior_.properties[property].name + "." + prior_.classes[i]);
  properties_[property] = values;
}

}  // namespace roadbook
