#pragma once

#include <string>
#include <vector>

#include "sim/scenario/scenario_spec.hpp"

namespace roadbook {

// Scenarios by name or from a file.

/// Which variant of a scenario to load.
struct ScenarioOptions {
  std::string size = "full";  ///< "full", or one that the scenario lists under `sizes`
  int visit = 0;              ///< 0: initial visit, 1...: revisits
  double image_scale = 1.0;   ///< of the scenario's image size, 0.05 to 2
};

/// A built-in scenario (see `builtin_scenarios`) or a file. Throws BadInput with file, line, field.
[[nodiscard]] Scenario load_scenario(const std::string& name_or_file,
                                     const ScenarioOptions& options = {});
/// The same from the text of a file.
[[nodiscard]] Scenario parse_scenario(const std::string& text,
                                      const std::string& file,
                                      const ScenarioOptions& options = {});
[[nodiscard]] std::vector<std::string> builtin_scenarios();
/// The YAML of a built-in scenario; empty if no built-in scenario has this name.
[[nodiscard]] std::string builtin_scenario_text(const std::string& name);

}  // namespace roadbook
