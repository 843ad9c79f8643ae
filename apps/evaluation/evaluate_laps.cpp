#include <nlohmann/json.hpp>

#include "apps/evaluate.hpp"
#include "base/format.hpp"
#include "base/whole_file.hpp"
#include "speedmap/experiments/lap_study.hpp"
#include "speedmap/experiments/spm_experiment.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

void run_laps(Console& console, const EvaluateCommand& command) {
  if (command.data.empty())
    throw InvalidOption("--data", "nothing", "a table of a car that drove two laps");
  const LapData laps = read_laps(command.data);
  const auto scores = run_lap_study(laps, command.threads);
  ordered_json json{{"experiment", "laps"},
                    {"length_m", laps.length_m},
                    {"horizons", scores.front().mean_abs.size()},
                    {"mean_abs_error_deg", ordered_json::array()}};
  for (const LapScore& score : scores) {
    const double median = quantile(score.mean_abs, 0.5);
    const double upper = quantile(score.mean_abs, 0.9);
    console.say(score.method + ": mean error along a horizon [deg]: median " + fixed(median, 3) +
                ", 90 % " + fixed(upper, 3));
    json["mean_abs_error_deg"].push_back(
        {{"method", score.method}, {"median", median}, {"p90", upper}});
  }
  write_whole_file(command.out / "result.json", json.dump(2) + "\n");
  console.result(json);
}

}  // namespace

Experiment laps_experiment() {
  return {"laps", "cross slope of a real car's second lap, predicted from its first (--data TABLE)",
          run_laps};
}

}  // namespace roadbook
