#pragma once

#include "base/error.hpp"
#include "base/yaml.hpp"

namespace roadbook {

/// Converts an error about an option to an error about the configuration file, with file and line.
/// The line is that of the option's own key, or else of the first key that `want` names.
[[nodiscard]] Problem located(Problem fault, const YamlMap& yaml);

/// Runs `check`. If an option is outside its range, throws BadInput about `yaml`'s file.
template <typename Check>
void check_config(const YamlMap& yaml, const Check& check) {
  try {
    check();
  } catch (const InvalidOption& fault) {
    throw BadInput(located(fault.problem(), yaml));
  }
}

}  // namespace roadbook
