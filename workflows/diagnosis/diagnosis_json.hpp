#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "diagnosis/inference/findings.hpp"

namespace roadbook {

/// What `diagnose --json` prints.
[[nodiscard]] nlohmann::ordered_json to_json(const Diagnosis& diagnosis);

/// The same in lines for people.
[[nodiscard]] std::vector<std::string> to_lines(const Diagnosis& diagnosis);

}  // namespace roadbook
