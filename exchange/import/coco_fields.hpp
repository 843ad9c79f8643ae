#pragma once

#include <string>
#include <string_view>

namespace roadbook {

// Names of fields that programs add to COCO's annotations and their `attributes`, in any case.

/// What a field says where it is set: that an annotation is a group, is to be ignored or is not in
/// the image ("0: a group is no single thing"). Empty for fields that say nothing of the kind.
[[nodiscard]] std::string_view meaning_of_coco_flag(const std::string& name);

/// Whether a field turns a box, in ways that differ between programs: in sense, unit and point.
[[nodiscard]] bool may_turn_coco_box(const std::string& name);

}  // namespace roadbook
