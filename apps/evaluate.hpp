#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "apps/console.hpp"

namespace roadbook {

// `roadbook evaluate EXPERIMENT`: the experiments of the three source documents (docs/concepts.md)
// and further studies.

/// The arguments of every experiment.
struct EvaluateCommand {
  std::string experiment;
  std::filesystem::path out;     ///< folder for figures and results
  std::filesystem::path config;  ///< parameters of the experiment, if it has any; may be empty
  std::filesystem::path data;    ///< recording, if the experiment needs one; may be empty
  std::string only;              ///< prefixes of effect names, "a,b" for several (diagnosis)
  std::uint64_t seed = 1;
  int repeats = 0;     ///< worlds, maps or draws; 0: number of the experiment
  bool quick = false;  ///< only the main result
  int threads = 0;
};

/// One experiment: writes its figures to `out` and its result to the console.
struct Experiment {
  std::string name;
  std::string summary;
  std::function<void(Console&, const EvaluateCommand&)> run;
};

Experiment spm_experiment();
Experiment diagnosis_experiment();
Experiment speeds_experiment();
Experiment people_experiment();
Experiment labels_experiment();
Experiment laps_experiment();
Experiment rows_experiment();
Experiment robustness_experiment();
Experiment covariance_experiment();
Experiment localisation_experiment();
Experiment sessions_experiment();
Experiment occupancy_experiment();

/// Returns all experiments. To add one, declare its function above and list it in
/// apps/verbs/evaluate_verb.cpp.
[[nodiscard]] std::vector<Experiment> all_experiments();

}  // namespace roadbook
