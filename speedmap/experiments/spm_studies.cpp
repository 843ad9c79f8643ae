#include "speedmap/experiments/spm_studies.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "base/random.hpp"

namespace roadbook {

std::vector<SpmMethod> spm_ablation_methods() {
  std::vector<SpmMethod> methods;
  const auto add = [&](const char* name, const auto& change) {
    SpmMethod method;
    method.name = name;
    change(method);
    methods.push_back(method);
  };
  add("default", [](SpmMethod&) {});
  add("prior as given", [](SpmMethod& m) { m.map.prior_mean_sigma = 0.0; });
  add("no evidence gate", [](SpmMethod& m) { m.map.gate_counts = 0.0; });
  add("no refresh", [](SpmMethod& m) { m.refresh.enabled = false; });
  add("no refresh by evidence", [](SpmMethod& m) { m.refresh.drop_nat = 0.0; });
  add("refresh by evidence alone",
      [](SpmMethod& m) { m.refresh.early_every_m = m.refresh.every_m = 1e9; });
  add("refresh from plain weights", [](SpmMethod& m) { m.refresh.classes.start_sharpness = 1.0; });
  add("no outliers expected", [](SpmMethod& m) { m.map.outlier_weight = 0.0; });
  add("natural projection",
      [](SpmMethod& m) { m.map.normal_gamma = NormalGammaProjection::kNatural; });
  add("KL projection", [](SpmMethod& m) { m.map.normal_gamma = NormalGammaProjection::kKl; });
  add("printed projection (13)", [](SpmMethod& m) {
    m.map.normal_gamma = NormalGammaProjection::kPrinted;
    m.map.dirichlet = DirichletProjection::kPrinted;
  });
  add("gamma ratio inside the root (12c)", [](SpmMethod& m) { m.map.literal_root = true; });
  add("fractional counts",
      [](SpmMethod& m) { m.map.dirichlet = DirichletProjection::kFractional; });
  add("labels by (9)", [](SpmMethod& m) { m.map.semantics = SemanticModel::kGeometricPool; });
  add("a label worth 0.1", [](SpmMethod& m) { m.label_weight = 0.1; });
  return methods;
}

std::vector<SpmForgettingScore> spm_forgetting_study(std::uint64_t seed) {
  constexpr double kRate = 40.0;
  constexpr int kValues = 24000;
  std::vector<SpmForgettingScore> scores;
  // 69 and 34 values are factors of 0.99 and 0.98 a value.
  for (const double half_life : {0.0, 690.0, 69.0, 34.0}) {
    SpmForgettingScore score{half_life, 0.0, 0.0};
    for (const bool drying : {true, false}) {
      PropertyMapPrior prior;
      prior.classes = {"dry", "wet"};
      prior.counts = {1.0, 1.0};
      PropertyPrior friction;
      friction.classes = {{0.95, 1.0, 2.0, 0.003}, {0.45, 1.0, 2.0, 0.003}};
      prior.properties.push_back(friction);
      PropertyMapOptions options;
      options.half_life_values = half_life;
      PropertyMap map(Knots({{0.0, 0.0}, {50.0, 0.0}}, {2.0, 2.0}, std::nullopt), prior, options);
      for (int i = 0; i < 200; ++i) {
        map.add_label({0.0, 0.0}, 0);
        map.add_label({50.0, 0.0}, 1);
      }
      Random random(seed, "spm.forgetting");
      double& error = drying ? score.drying_error : score.steady_error;
      for (int i = 0; i < kValues; ++i) {
        const double t = i / kRate;
        const double wet = drying ? 0.85 - 0.40 * std::exp(-t / 120.0) : 0.45;
        map.add_value(0, {0.0, 0.0}, random.normal(0.95, 0.04));
        map.add_value(0, {50.0, 0.0}, random.normal(wet, 0.05));
        error += std::abs(map.property(0)[1].mu - wet) / kValues;
      }
    }
    scores.push_back(score);
  }
  return scores;
}

std::vector<SpmOutlierScore> spm_outlier_study(const SpmExperimentOptions& options,
                                               int maps,
                                               int num_threads) {
  const PathFrame road = spm_road(options);
  const std::vector<double> weights = {0.0, 0.02, 0.05};
  const std::vector<double> shares = {0.0, 0.05};
  std::vector<std::vector<SpmOutlierScore>> of_map(static_cast<std::size_t>(maps));
  parallel_for(of_map.size(), num_threads, [&](std::size_t index) {
    const SpmTruth truth = spm_truth(options, index);
    const SpmRecord clean = spm_record(options, road, truth, index, options.score_until_m);
    for (const double share : shares)
      for (const double weight : weights) {
        SpmRecord record = clean;
        Random random(options.seed, "spm.outliers", index);
        for (SpmValue& value : record.values)
          if (random.uniform() < share) value.friction = random.uniform(0.0, 1.5);
        SpmMethod method;
        method.map.outlier_weight = weight;
        const SpmMapRun run = run_spm(options, truth, record, method, index);
        of_map[index].push_back({weight, share, run.kl.back(), run.worst_class_error});
      }
  });
  std::vector<SpmOutlierScore> scores = of_map.front();
  for (std::size_t i = 0; i < scores.size(); ++i) {
    scores[i].kl = scores[i].mean_error = 0.0;
    for (const auto& one : of_map) {
      scores[i].kl += one[i].kl / maps;
      scores[i].mean_error += one[i].mean_error / maps;
    }
  }
  return scores;
}

}  // namespace roadbook
