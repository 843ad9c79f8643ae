#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "semantics/labels/label_classes.hpp"
#include "semantics/labels/labels.hpp"

namespace roadbook {

// A class of which there are labels is not removed, neither by a new list nor by a step back.
// Classes are of things on the ground: windows in images count for none.

/// Classes of active labels, each once; a label of not_X is of none.
[[nodiscard]] std::vector<std::string> kinds_in_use(const std::map<std::int64_t, Label>& labels);

/// A class that `shown` has, `wanted` lacks, and of which there are labels.
[[nodiscard]] std::optional<std::string> class_in_use(const std::map<std::int64_t, Label>& labels,
                                                      const std::vector<LabelClass>& shown,
                                                      const std::vector<LabelClass>& wanted);

}  // namespace roadbook
