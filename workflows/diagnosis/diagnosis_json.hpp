#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "diagnosis/inference/findings.hpp"

namespace roadbook {

/// Returns the output of `diagnose --json`.
[[nodiscard]] nlohmann::ordered_json to_json(const Diagnosis& diagnosis);

/// Returns the same content as lines of text.
[[nodiscard]] std::vector<std::string> to_lines(const Diagnosis& diagnosis);

}  // namespace roadbook
