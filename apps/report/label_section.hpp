#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "apps/report/label_rounds_section.hpp"
#include "workflows/report/label_report.hpp"

namespace roadbook {

// The part of the report about the labels of a map.

[[nodiscard]] std::string label_section(const LabelReport& report, const LabelRounds& rounds);
[[nodiscard]] nlohmann::ordered_json label_report_json(const LabelReport& report,
                                                       const LabelRounds& rounds);

}  // namespace roadbook
