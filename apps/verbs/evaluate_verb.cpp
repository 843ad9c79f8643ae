#include <algorithm>
#include <memory>

#include "apps/evaluate.hpp"
#include "apps/verb.hpp"
#include "base/text.hpp"

namespace roadbook {
namespace {

ExitStatus run_evaluate(const EvaluateCommand& command, Console& console) {
  std::vector<std::string> names;
  for (const Experiment& experiment : all_experiments()) {
    names.push_back(experiment.name);
    if (experiment.name != command.experiment) continue;
    std::error_code error;
    std::filesystem::create_directories(command.out, error);
    if (error)
      throw StorageError("error: " + command.out.string() + ": folder: got " + error.message() +
                         ", want one to write to");
    experiment.run(console, command);
    return ExitStatus::kDone;
  }
  std::string want;
  for (const std::string& name : names) want += (want.empty() ? "" : ", ") + name;
  if (const auto near = nearest_name(command.experiment, names))
    want += "; did you mean " + *near + "?";
  throw InvalidOption("EXPERIMENT", "'" + command.experiment + "'", want);
}

}  // namespace

std::vector<Experiment> all_experiments() {
  return {spm_experiment(),          speeds_experiment(),     people_experiment(),
          labels_experiment(),       laps_experiment(),       rows_experiment(),
          diagnosis_experiment(),    robustness_experiment(), covariance_experiment(),
          localisation_experiment(), sessions_experiment(),   occupancy_experiment()};
}

Verb evaluate_verb() {
  auto command = std::make_shared<EvaluateCommand>();
  command->out = "evaluation";
  return {"evaluate", "repeats an experiment or a study",
          [command](Options& options) {
            std::string names;
            for (const Experiment& experiment : all_experiments())
              names += (names.empty() ? "" : "; ") + experiment.name + ": " + experiment.summary;
            options.add("EXPERIMENT", &command->experiment, names).required = true;
            options.add("--out,-o", &command->out, "folder for figures and results");
            options.add("--config", &command->config, "YAML file with the experiment's parameters");
            options.add("--data", &command->data,
                        "recording (laps, occupancy) or annotated pictures (labels)");
            options.add("--only", &command->only,
                        "beginning of the names to run: effects, several with commas (diagnosis), "
                        "drives (rows), faults (robustness), or kinds of drives (covariance)");
            options.add("--seed", &command->seed, "seed of all random numbers");
            options
                .add("--repeats", &command->repeats,
                     "number of simulated worlds; 0: that of the experiment")
                .range = {0, 1000};
            options.add("--quick", &command->quick, "only the main result");
          },
          [command](Console& console, const CommonOptions& common) {
            command->threads = common.threads;
            return run_evaluate(*command, console);
          }};
}

}  // namespace roadbook
