#include "speedmap/experiments/spm_run.hpp"

namespace roadbook {

std::vector<SpmMethod> spm_methods() {
  std::vector<SpmMethod> methods;
  SpmMethod literal;
  literal.name = "literal prior, printed (13)";
  literal.map.prior_mean_sigma = 0.0;
  literal.map.semantics = SemanticModel::kGeometricPool;
  literal.map.normal_gamma = NormalGammaProjection::kPrinted;
  literal.map.dirichlet = DirichletProjection::kPrinted;
  literal.map.outlier_weight = 0.0;
  literal.map.gate_counts = 0.0;
  literal.refresh.enabled = false;
  methods.push_back(literal);

  SpmMethod predictive = literal;
  predictive.name = "literal prior, predictive + trace";
  predictive.map.normal_gamma = NormalGammaProjection::kPredictive;
  predictive.map.dirichlet = DirichletProjection::kTrace;
  methods.push_back(predictive);

  SpmMethod calibrated = literal;
  calibrated.name = "calibrated prior and gate, printed (13)";
  calibrated.map.prior_mean_sigma = PropertyMapOptions{}.prior_mean_sigma;
  calibrated.map.gate_counts = 5.0;
  methods.push_back(calibrated);

  calibrated = predictive;
  calibrated.name = "calibrated prior and gate, predictive + trace";
  calibrated.map.prior_mean_sigma = PropertyMapOptions{}.prior_mean_sigma;
  calibrated.map.gate_counts = 5.0;
  methods.push_back(calibrated);

  calibrated.name = "+ batch refresh";
  calibrated.refresh.enabled = true;
  calibrated.refresh.drop_nat = 0.0;
  methods.push_back(calibrated);

  calibrated.name = "+ linear pool, fractional counts";
  calibrated.map.semantics = SemanticModel::kLinearPool;
  calibrated.map.dirichlet = DirichletProjection::kFractional;
  methods.push_back(calibrated);

  calibrated.name = "+ linear pool, trace";
  calibrated.map.dirichlet = DirichletProjection::kTrace;
  methods.push_back(calibrated);

  methods.push_back({});
  methods.back().name = "default: + outliers, refresh when the evidence drops";
  return methods;
}

std::vector<SpmMethod> spm_sensitivity_methods(const SpmExperimentOptions& options) {
  std::vector<SpmMethod> methods;
  const auto add = [&](double spacing_m, double width_m) {
    SpmMethod method;
    method.knot_spacing_m = spacing_m;
    method.kernel_width_m = width_m;
    method.name = "knots " + std::to_string(spacing_m).substr(0, 4) + " m, D " +
                  std::to_string(width_m).substr(0, 4) + " m";
    methods.push_back(method);
  };
  for (const double spacings : {1.0, 1.5, 2.0, 3.0})
    add(options.spacing_m, spacings * options.spacing_m);
  for (const double pitch : {0.5, 0.75, 1.5, 2.0})
    add(pitch * options.spacing_m, 2.0 * pitch * options.spacing_m);
  return methods;
}

}  // namespace roadbook
