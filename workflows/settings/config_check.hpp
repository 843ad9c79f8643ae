#pragma once

#include "base/error.hpp"
#include "base/yaml.hpp"

namespace roadbook {

/// The fault of an option as one of the configuration it was read from: with file and line, at the
/// option's own key, else at the first key that `want` compares it with.
[[nodiscard]] Problem located(Problem fault, const YamlMap& yaml);

/// Runs `check`; an option outside its range becomes BadInput of `yaml`'s file.
template <typename Check>
void check_config(const YamlMap& yaml, const Check& check) {
  try {
    check();
  } catch (const InvalidOption& fault) {
    throw BadInput(located(fault.problem(), yaml));
  }
}

}  // namespace roadbook
