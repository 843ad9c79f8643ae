#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/inference/findings.hpp"
#include "workflows/diagnosis/advice.hpp"

namespace roadbook {

/// Returns the output of `diagnose --json`.
[[nodiscard]] nlohmann::ordered_json to_json(const Diagnosis& diagnosis);

/// The advice (`advice_of`) and the errors of dead reckoning that `diagnose --json` adds to it:
/// null where they were not measured.
[[nodiscard]] nlohmann::ordered_json advice_json(const Diagnosis& diagnosis,
                                                 const std::optional<StatedVehicle>& stated);

/// The recorded drive against its simulations (`diagnose --compare`), by stream and channel.
[[nodiscard]] nlohmann::ordered_json comparison_json(const Diagnosis& diagnosis);
[[nodiscard]] std::vector<std::string> comparison_lines(const Diagnosis& diagnosis);

/// Returns the same content as lines of text.
[[nodiscard]] std::vector<std::string> to_lines(const Diagnosis& diagnosis);

}  // namespace roadbook
