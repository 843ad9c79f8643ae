#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "apps/console.hpp"

namespace roadbook {

// `roadbook evaluate EXPERIMENT`: the experiments of the source documents, each with its figures.

/// What every experiment is given.
struct EvaluateCommand {
  std::string experiment;
  std::filesystem::path out;     ///< folder for figures and results
  std::filesystem::path config;  ///< parameters of the experiment, where it has any; may be empty
  std::filesystem::path data;    ///< recording, where the experiment is about one; may be empty
  std::string only;              ///< effects whose names begin so, "a,b" for several (diagnosis)
  std::uint64_t seed = 1;
  int repeats = 0;     ///< worlds, maps, draws; 0: as many as the document
  bool quick = false;  ///< the main result alone
  int threads = 0;
};

/// One of them: writes its figures to `out` and its result to the console.
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

/// All of them. A new one adds its function above and its call here (apps/verbs/evaluate_verb.cpp).
[[nodiscard]] std::vector<Experiment> all_experiments();

}  // namespace roadbook
