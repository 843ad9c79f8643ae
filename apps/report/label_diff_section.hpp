#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "semantics/labels/label_diff.hpp"

namespace roadbook {

// What people have done to the labels since an earlier version of a map, as parts of the report.

/// Returns one line: the number of labels added, deleted, restored and changed, and the users who
/// did it.
[[nodiscard]] std::string label_diff_line(const std::vector<LabelDifference>& differences,
                                          const std::string& before);
/// The line and, folded, each of them with its fields.
[[nodiscard]] std::string label_diff_section(const std::vector<LabelDifference>& differences,
                                             const std::string& before);
[[nodiscard]] nlohmann::ordered_json label_diff_json(
    const std::vector<LabelDifference>& differences, const std::string& before);

}  // namespace roadbook
