#pragma once

#include <string>

#include "sim/scenario/scenario_spec.hpp"
#include "sim/scenario/yaml_reader.hpp"

namespace roadbook {

/// All of a scenario from its root mapping, checked: unknown keys, ranges, names that refer to
/// nothing. Throws BadInput.
[[nodiscard]] Scenario read_scenario(const YamlReader& root, const std::string& file);

}  // namespace roadbook
