#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/evaluate.hpp"
#include "apps/evaluation/evaluate_spm_picture.hpp"
#include "apps/report/chart.hpp"
#include "base/format.hpp"
#include "base/whole_file.hpp"
#include "speedmap/experiments/spm_experiment.hpp"
#include "speedmap/experiments/spm_studies.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

// Returns the KL divergence of all maps at one scored distance.
std::vector<double> kl_at(const SpmMethodScore& score, std::size_t i) {
  std::vector<double> values;
  for (const auto& map : score.kl) values.push_back(map[i]);
  return values;
}

std::string figure2(const SpmExperiment& result) {
  std::vector<ChartSeries> series;
  for (const SpmMethodScore& score : result.methods) {
    ChartSeries one{score.method, {}, {}, score.method.starts_with("literal")};
    for (std::size_t i = 0; i < score.distance_m.size(); ++i) {
      const MeanInterval interval = mean_interval95(kl_at(score, i));
      one.points.emplace_back(score.distance_m[i], interval.mean);
      one.half_width.push_back(interval.half);
    }
    series.push_back(std::move(one));
  }
  return chart_svg({"KL divergence of the estimated from the true map (mean and 95 % interval)",
                    "distance travelled [m]", "KL [nat]", 0.0, 2.5},
                   series);
}

std::string figure3(const std::vector<SpmHorizonScore>& horizons) {
  std::vector<ChartSeries> series;
  for (const SpmHorizonScore& score : horizons) {
    ChartSeries one{score.method, {}, {}, score.method.starts_with("KF")};
    for (int percent = 1; percent <= 99; ++percent)
      one.points.emplace_back(quantile(score.errors.mean_abs, 0.01 * percent), percent);
    series.push_back(std::move(one));
  }
  return chart_svg({"Mean error of the predicted friction along a horizon: share of horizons below",
                    "mean |error| [-]", "horizons [%]", 0.0, 100.0},
                   series);
}

ordered_json spm_json(const SpmMethodScore& score) {
  ordered_json kl = ordered_json::array();
  for (std::size_t i = 0; i < score.distance_m.size(); ++i) {
    const auto values = kl_at(score, i);
    const MeanInterval interval = mean_interval95(values);
    kl.push_back({{"distance_m", score.distance_m[i]},
                  {"mean", interval.mean},
                  {"interval95", {interval.mean - interval.half, interval.mean + interval.half}},
                  {"median", quantile(values, 0.5)}});
  }
  return {{"method", score.method},
          {"improved", score.improved},
          {"locked", score.locked},
          {"rejected_updates", score.rejected},
          {"kl_whole_road_start", mean_interval95(score.kl_all_start).mean},
          {"kl_whole_road_end", mean_interval95(score.kl_all_end).mean},
          {"kl", kl}};
}

ordered_json spm_json(const std::vector<SpmHorizonScore>& horizons) {
  ordered_json list = ordered_json::array();
  for (const SpmHorizonScore& score : horizons)
    list.push_back({{"method", score.method},
                    {"horizons", score.errors.mean_abs.size()},
                    {"median_abs_error", quantile(score.errors.mean_abs, 0.5)},
                    {"p90_abs_error", quantile(score.errors.mean_abs, 0.9)},
                    {"median_rms_error", quantile(score.errors.rms, 0.5)},
                    {"median_nll", quantile(score.errors.nll, 0.5)}});
  return list;
}

void say_scores(const Console& console, const SpmExperiment& result) {
  for (const SpmMethodScore& score : result.methods) {
    const MeanInterval start = mean_interval95(kl_at(score, 0));
    const MeanInterval end = mean_interval95(kl_at(score, score.distance_m.size() - 1));
    console.say(score.method + ": KL " + fixed(start.mean, 3) + " -> " + fixed(end.mean, 3) +
                " +- " + fixed(end.half, 3) + "; " + std::to_string(score.improved) + " of " +
                std::to_string(score.kl.size()) + " maps better, " + std::to_string(score.locked) +
                " with a class mean wrong by more than 0.1");
  }
  for (const SpmHorizonScore& score : result.horizons)
    console.say(score.method + ": median error along a horizon " +
                fixed(quantile(score.errors.mean_abs, 0.5), 4));
}

SpmExperimentOptions spm_options(const EvaluateCommand& command) {
  SpmExperimentOptions options;
  if (!command.config.empty()) options = SpmExperimentOptions::load(command.config);
  if (command.config.empty()) options.seed = command.seed;
  if (command.repeats > 0) options.maps = command.repeats;
  return options;
}

ordered_json labels_json(const std::vector<SpmLabelScore>& scores) {
  ordered_json list = ordered_json::array();
  for (const SpmLabelScore& score : scores)
    list.push_back({{"method", score.method},
                    {"errors", score.blobs ? "blobs" : "independent"},
                    {"class_nll", score.class_nll},
                    {"class_ece", score.class_ece},
                    {"friction_error", score.mean_error},
                    {"z_sd", score.z_sd},
                    {"z_outside95", score.z_outside95}});
  return list;
}

// Compares the methods by their last KL divergence and their horizons.
ordered_json comparison_json(const SpmExperiment& result) {
  ordered_json list = ordered_json::array();
  for (std::size_t i = 0; i < result.methods.size(); ++i) {
    list.push_back(spm_json(result.methods[i]));
    list.back()["median_abs_error"] = quantile(result.horizons[i].errors.mean_abs, 0.5);
  }
  return list;
}

// Runs the studies of each design choice by itself.
void run_studies(Console& console,
                 const EvaluateCommand& command,
                 const SpmExperimentOptions& options,
                 ordered_json& json) {
  const auto compare = [&](const std::vector<SpmMethod>& methods) {
    const SpmExperiment result =
        run_spm_experiment(options, methods, false, command.threads, console.progress());
    say_scores(console, result);
    return comparison_json(result);
  };
  json["sensitivity"] = compare(spm_sensitivity_methods(options));
  json["one_change_from_default"] = compare(spm_ablation_methods());
  const int few = std::min(options.maps, 3);
  json["labels"] = labels_json(spm_label_study(options, few, command.threads));
  json["forgetting"] = ordered_json::array();
  for (const SpmForgettingScore& score : spm_forgetting_study(options.seed))
    json["forgetting"].push_back({{"half_life_values", score.half_life_values},
                                  {"drying_error", score.drying_error},
                                  {"steady_error", score.steady_error}});
  json["outliers"] = ordered_json::array();
  for (const SpmOutlierScore& score : spm_outlier_study(options, few, command.threads))
    json["outliers"].push_back({{"outlier_weight", score.outlier_weight},
                                {"share", score.share},
                                {"kl", score.kl},
                                {"class_mean_error", score.mean_error}});
}

void run_spm_evaluation(Console& console, const EvaluateCommand& command) {
  const SpmExperimentOptions options = spm_options(command);
  const std::vector<SpmMethod> methods = spm_methods();
  const SpmExperiment result =
      run_spm_experiment(options, methods, !command.quick, command.threads, console.progress());
  write_whole_file(command.out / "figure1.svg", spm_picture(options));
  write_whole_file(command.out / "figure2.svg", figure2(result));
  write_whole_file(command.out / "figure3.svg", figure3(result.horizons));
  write_whole_file(command.out / "figure3_drivable.svg", figure3(result.drivable));
  ordered_json json{{"experiment", "spm"},
                    {"maps", options.maps},
                    {"seed", options.seed},
                    {"pixels_per_frame", result.pixels_per_frame},
                    {"figure2", ordered_json::array()},
                    {"figure3", spm_json(result.horizons)},
                    {"figure3_drivable", spm_json(result.drivable)}};
  for (const SpmMethodScore& score : result.methods) json["figure2"].push_back(spm_json(score));
  say_scores(console, result);
  if (!command.quick) {
    json["maps_with_rms_below_half_of_kf_and_gp"] = maps_below_half(
        result.horizons, methods.size() - 1, methods.size(), result.horizons_per_map);
    run_studies(console, command, options, json);
  }
  write_whole_file(command.out / "result.json", json.dump(2) + "\n");
  console.result(json);
}

}  // namespace

Experiment spm_experiment() {
  return {"spm", "semantic property map on ten simulated roads (semantic property maps, section 4)",
          run_spm_evaluation};
}

}  // namespace roadbook
