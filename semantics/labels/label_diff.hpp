#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "semantics/labels/label_store.hpp"

namespace roadbook {

// Differences between the labels of two versions of a map. Labels are compared as stored, relative
// to vehicle poses: a label that only moved with its map is not changed.

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

/// A field of a label whose value differs.
struct LabelFieldChange {
  /// Name of the field in the map's events (docs/reference/map_file.md): `kind`, `middle`, ...
  std::string field;
  nlohmann::ordered_json from;  ///< null: the field was absent; of `pictures` the SHA-256 digest
  nlohmann::ordered_json to;
  std::string who;        ///< labeller who set the newest value
  std::int64_t t_ns = 0;  ///< time of that edit, since 1970 [ns]
};

struct LabelDifference {
  LabelDifferenceKind kind = LabelDifferenceKind::kChanged;
  Label label;            ///< newest state; of a deleted label its last state
  std::string who;        ///< who added, deleted, restored or last changed it; empty: not recorded
  std::int64_t t_ns = 0;  ///< time of that edit, since 1970 [ns]
  std::vector<LabelFieldChange> fields;  ///< only for kChanged and kRestored
};

/// Compares the labels of two event logs: labels on the ground, window labels and rejections,
/// sorted by id. Edits without net effect (drawn then deleted, changed and undone) are no
/// difference; versions, editors and `seen` are not compared. Two labels are the same if the same
/// event (id, labeller, time) created them. Labels of separately edited copies can share an id:
/// they count as one deleted and one added.
[[nodiscard]] std::vector<LabelDifference> label_differences(const std::vector<LabelEvent>& before,
                                                             const std::vector<LabelEvent>& after);

}  // namespace roadbook
