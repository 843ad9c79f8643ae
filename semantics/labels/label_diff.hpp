#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "semantics/labels/label_store.hpp"

namespace roadbook {

// What people have done to the labels between two versions of a map. Compared is what is stored,
// which hangs on vehicle poses: a label that has only moved with its map is not changed.

enum class LabelDifferenceKind { kAdded, kDeleted, kRestored, kChanged };

[[nodiscard]] constexpr const char* to_text(LabelDifferenceKind kind) {
  switch (kind) {
    case LabelDifferenceKind::kAdded:
      return "added";
    case LabelDifferenceKind::kDeleted:
      return "deleted";
    case LabelDifferenceKind::kRestored:
      return "restored";
    case LabelDifferenceKind::kChanged:
      return "changed";
  }
  return "";
}

/// A field whose value is another.
struct LabelFieldChange {
  std::string field;  ///< as the map's events name it (docs/reference/map_file.md): `kind`, `middle`, ...
  nlohmann::ordered_json from;  ///< null: it had none; of `pictures` their digest
  nlohmann::ordered_json to;
  std::string who;        ///< gave it the value it has now
  std::int64_t t_ns = 0;  ///< when, since 1970
};

struct LabelDifference {
  LabelDifferenceKind kind = LabelDifferenceKind::kChanged;
  Label label;            ///< as it stands now; one that is gone, as it stood
  std::string who;        ///< added, deleted, restored or last changed it; empty: no event tells
  std::int64_t t_ns = 0;  ///< when, since 1970
  std::vector<LabelFieldChange> fields;  ///< of what was changed or restored
};

/// Labels by id, on the ground and in images, rejections too. What has come to nothing in between
/// (drawn and deleted, changed and put back) is no difference, nor is a label's number of changes
/// or that somebody saw it again. A label is the same in both where the same event made it: of maps
/// that were labelled apart, what has the same number may be two, one deleted and one added.
[[nodiscard]] std::vector<LabelDifference> label_differences(const std::vector<LabelEvent>& before,
                                                             const std::vector<LabelEvent>& after);

}  // namespace roadbook
