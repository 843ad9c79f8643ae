#include <array>
#include <cmath>
#include <string>

#include "base/error.hpp"
#include "speedmap/property_map/property_map.hpp"

namespace roadbook {
namespace {

[[noreturn]] void refuse(const char* field, const std::string& got, const std::string& want) {
  throw BadInput(Problem{Severity::kError, "", 0, field, got, want});
}

void check_place(const PathPlace& v) {
  if (!std::isfinite(v.s_m)) refuse("s_m", std::to_string(v.s_m), "a finite number");
  if (!std::isfinite(v.e_m)) refuse("e_m", std::to_string(v.e_m), "a finite number");
}

}  // namespace

bool PropertyMap::add_label(const PathPlace& v, int label, double weight) {
  if (label < 0 || label >= static_cast<int>(classes()))
    refuse("class", std::to_string(label), "0 to " + std::to_string(classes() - 1));
  std::array<double, kMaxPropertyClasses> weights{};
  weights[static_cast<std::size_t>(label)] = weight;
  return add_labels(v, {weights.data(), classes()});
}

bool PropertyMap::add_labels(const PathPlace& v, std::span<const double> weights) {
  check_place(v);
  if (weights.size() != classes())
    refuse("class", std::to_string(weights.size()) + " weights", std::to_string(classes()));
  double total = 0.0;
  for (const double weight : weights) {
    if (!(std::isfinite(weight) && weight >= 0.0))
      refuse("weight", std::to_string(weight), "a number of 0 or more");
    total += weight;
  }
  interpolate(knots_, v, near_);
  if (!near_.covered()) return false;
  switch (options_.semantics) {
    case SemanticModel::kGeometricPool:
      add_geometric(weights);
      break;
    case SemanticModel::kLinearPool:
      add_linear(weights);
      break;
    case SemanticModel::kDiscrete:
      add_discrete(weights);
      break;
  }
  for (std::size_t n = 0; n < near_.size(); ++n)
    evidence_[static_cast<std::size_t>(near_.knots[n])] += total * near_.weights[n];
  return true;
}

void PropertyMap::add_geometric(std::span<const double> weights) {
  for (std::size_t n = 0; n < near_.size(); ++n) {
    double* const a = &belief_[static_cast<std::size_t>(near_.knots[n]) * classes()];
    for (std::size_t i = 0; i < weights.size(); ++i) a[i] += near_.weights[n] * weights[i];
  }
}

void PropertyMap::add_discrete(std::span<const double> weights) {
  const std::size_t K = classes();
  for (std::size_t n = 0; n < near_.size(); ++n) {
    double* const log_p = &belief_[static_cast<std::size_t>(near_.knots[n]) * K];
    double top = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < K; ++i) {
      double change = 0.0;
      for (std::size_t c = 0; c < K; ++c)
        if (weights[c] > 0.0) change += weights[c] * log_confusion_[i * K + c];
      log_p[i] += near_.weights[n] * change;
      top = std::max(top, log_p[i]);
    }
    // Only differences count; kept near 0 so that they stay exact after millions of labels.
    for (std::size_t i = 0; i < K; ++i) log_p[i] -= top;
  }
}

// Each label of weight w is w labels of a mixture with known posterior: it came from class i of
// knot l with probability rho_li ~ I_l u_i^l C[i][c]. A fraction of a label (w < 1) is one that is
// informative with probability w. Labels of several classes are applied one class after the other.
void PropertyMap::add_linear(std::span<const double> weights) {
  const std::size_t K = classes();
  std::array<double, kMaxPropertyClasses> rho{};
  for (std::size_t c = 0; c < K; ++c) {
    const double weight = weights[c];
    if (!(weight > 0.0)) continue;
    double evidence = 0.0;
    for (std::size_t n = 0; n < near_.size(); ++n) {
      const double* const a = &belief_[static_cast<std::size_t>(near_.knots[n]) * K];
      double sum = 0.0;
      double likely = 0.0;
      for (std::size_t i = 0; i < K; ++i) {
        sum += a[i];
        likely += a[i] * confusion_[i * K + c];
      }
      evidence += near_.weights[n] * likely / sum;
    }
    if (!(evidence > 0.0)) continue;  // no class can give this label
    const double scale = weight / evidence;
    for (std::size_t n = 0; n < near_.size(); ++n) {
      double* const a = &belief_[static_cast<std::size_t>(near_.knots[n]) * K];
      double sum = 0.0;
      for (std::size_t i = 0; i < K; ++i) sum += a[i];
      const double share = scale * near_.weights[n] / sum;
      for (std::size_t i = 0; i < K; ++i) rho[i] = share * a[i] * confusion_[i * K + c];
      // The matching of moments is defined for one label at most; more are counted.
      const DirichletProjection projection =
          weight <= 1.0 ? options_.dirichlet : DirichletProjection::kFractional;
      project_dirichlet({a, K}, {rho.data(), K}, projection);
    }
  }
}

}  // namespace roadbook
