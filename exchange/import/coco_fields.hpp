#pragma once

#include <string>
#include <string_view>

namespace roadbook {

// Names of fields that programs add to COCO's annotations and their `attributes`, in any case.

/// Returns the reason to leave out an annotation with this field set: it is a group, is to be
/// ignored or is not in the image ("0: a group is no single thing"). Empty for other fields.
[[nodiscard]] std::string_view meaning_of_coco_flag(const std::string& name);

/// Whether a field rotates a box. Programs differ in the sense, unit and centre of the rotation.
[[nodiscard]] bool may_turn_coco_box(const std::string& name);

}  // namespace roadbook
