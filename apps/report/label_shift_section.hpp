#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace roadbook {

struct LabelReport;  // apps/report/label_section.hpp

// How labels have moved with their map (document 004, Fig. 12), as parts of the report.

/// Mean, median and largest shift in words, and whether further images bear the places out.
[[nodiscard]] std::string shift_words(const LabelReport& report);
/// Which drives are in one of two maps alone, so that no label on them is compared; empty where
/// none is.
[[nodiscard]] std::string not_compared_line(const LabelReport& report);
/// Draws the earlier places below the current places, and the movement of their middles.
[[nodiscard]] std::string shift_picture(const LabelReport& report);
/// Labels that a person should look at, then every label's shift, folded.
[[nodiscard]] std::string shift_tables(const LabelReport& report);
/// The same numbers, the shift of each label in the order of ids.
[[nodiscard]] nlohmann::ordered_json shifts_json(const LabelReport& report);

}  // namespace roadbook
