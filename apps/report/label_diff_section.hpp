#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "semantics/labels/label_diff.hpp"

namespace roadbook {

// The parts of the report about the users' changes of labels since an earlier version of a map.

/// Returns one line: the number of labels added, deleted, restored and changed, and the users who
/// did it.
[[nodiscard]] std::string label_diff_line(const std::vector<LabelDifference>& differences,
                                          const std::string& before);
/// Returns the line and a folded list of the differences with their fields.
[[nodiscard]] std::string label_diff_section(const std::vector<LabelDifference>& differences,
                                             const std::string& before);
[[nodiscard]] nlohmann::ordered_json label_diff_json(
    const std::vector<LabelDifference>& differences, const std::string& before);

}  // namespace roadbook
