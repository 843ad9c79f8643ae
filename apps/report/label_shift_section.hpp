#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "workflows/report/label_report.hpp"

namespace roadbook {

// The parts of the report about the movement of labels with their map [metric-semantic maps, Fig.
// 12].

/// Describes the mean, median and largest shift, and whether further images confirm the places.
[[nodiscard]] std::string shift_words(const LabelReport& report);
/// Names the drives that only one of the two maps has. Their labels are not compared. Empty if both
/// maps have the same drives.
[[nodiscard]] std::string not_compared_line(const LabelReport& report);
/// Draws the earlier places below the current places, and the movement of their middles.
[[nodiscard]] std::string shift_picture(const LabelReport& report);
/// Lists the labels that a user should check, then the shift of every label, folded.
[[nodiscard]] std::string shift_tables(const LabelReport& report);
/// Returns the same numbers, with the shift of each label in the order of ids.
[[nodiscard]] nlohmann::ordered_json shifts_json(const LabelReport& report);

}  // namespace roadbook
