#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "semantics/labels/label_classes.hpp"
#include "semantics/labels/labels.hpp"

namespace roadbook {

// A class that has labels must not be removed, neither by a new list of classes nor by an undo.
// Only labels of things on the ground count; labels of image windows have no such class.

/// Classes of the active ground labels, sorted, each once. Rejections (class not_X) are not
/// counted.
[[nodiscard]] std::vector<std::string> kinds_in_use(const std::map<std::int64_t, Label>& labels);

/// First class that is in `shown`, missing in `wanted` and used by a label; empty if there is none.
[[nodiscard]] std::optional<std::string> class_in_use(const std::map<std::int64_t, Label>& labels,
                                                      const std::vector<LabelClass>& shown,
                                                      const std::vector<LabelClass>& wanted);

}  // namespace roadbook
