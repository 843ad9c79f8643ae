#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "apps/console.hpp"
#include "apps/options.hpp"

namespace roadbook {

/// The options that each verb has in addition to its own.
struct CommonOptions {
  bool json = false;
  bool quiet = false;
  int threads = 0;  ///< 0: all cores
  std::filesystem::path options_file;
};

/// One verb of the command: reads options, calls one pipeline function and prints the result.
struct Verb {
  std::string name;
  std::string summary;
  std::function<void(Options&)> declare;
  std::function<ExitStatus(Console&, const CommonOptions&)> run;
};

Verb simulate_verb();
Verb check_verb();
Verb import_verb();
Verb map_verb();
Verb calibrate_verb();
Verb compare_verb();
Verb curate_verb();
Verb edit_verb();
Verb localise_verb();
Verb overhead_verb();
Verb label_verb();
Verb layers_verb();
Verb roads_verb();
Verb detect_verb();
Verb occupancy_verb();
Verb diagnose_verb();
Verb export_verb();
Verb query_verb();
Verb report_verb();
Verb evaluate_verb();
Verb friction_verb();
Verb speeds_verb();
Verb completion_verb();

/// Returns all verbs, in the order of a user's work.
[[nodiscard]] std::vector<Verb> all_verbs();

/// Returns the options of `verb` and the common options.
[[nodiscard]] Options options_of(const Verb& verb, CommonOptions& common);

/// Runs the program with the words after its name. Returns the exit status.
[[nodiscard]] ExitStatus run_roadbook(const std::vector<std::string>& words);

}  // namespace roadbook
