#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "semantics/labels/label_effort.hpp"

namespace roadbook {

// The parts of the report about the effort of labelling a map.

[[nodiscard]] std::string effort_table(const LabelLedger& ledger);
/// Returns {classes: one entry per class, effort: total}.
[[nodiscard]] nlohmann::ordered_json effort_json(const LabelLedger& ledger);

}  // namespace roadbook
