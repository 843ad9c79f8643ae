#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "semantics/labels/label_effort.hpp"

namespace roadbook {

// What the labels of a map took to make, as parts of the report.

[[nodiscard]] std::string effort_table(const LabelLedger& ledger);
/// {classes: one a class, effort: of all}.
[[nodiscard]] nlohmann::ordered_json effort_json(const LabelLedger& ledger);

}  // namespace roadbook
