#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "semantics/labels/label_classes.hpp"
#include "semantics/labels/labels.hpp"

namespace roadbook {

// What the log of labels holds (semantics/labels/label_store.hpp).

/// kClasses: the list of classes was changed; the event has no label.
enum class LabelAction { kCreate, kChange, kDelete, kRestore, kClasses };

[[nodiscard]] constexpr const char* to_text(LabelAction action) {
  switch (action) {
    case LabelAction::kCreate:
      return "create";
    case LabelAction::kChange:
      return "change";
    case LabelAction::kDelete:
      return "delete";
    case LabelAction::kRestore:
      return "restore";
    case LabelAction::kClasses:
      return "classes";
  }
  return "";
}

struct LabelEvent {
  std::int64_t event = 0;  ///< from 1
  LabelAction action = LabelAction::kCreate;
  Label label;  ///< state after the event; for kClasses only version, who and t_ns are set
  /// Number of the event that this one reverts; 0: none.
  std::int64_t undoes = 0;
  bool together = false;              ///< stored by create_all, even if the list had only one label
  std::vector<LabelClass> classes{};  ///< for kClasses: the list after the event
  std::vector<LabelClass> classes_before{};  ///< for kClasses: the list before it
};

struct LabelClassList {
  std::vector<LabelClass> classes;
  std::int64_t version = 0;  ///< increases by one with each change; 0: never changed
  std::string who;           ///< who changed it last
  std::int64_t t_ns = 0;     ///< time of that change, since 1970 [ns]
};

/// Which step an undo or redo applies to.
struct StepBack {
  std::size_t count = 0;  ///< number of events; 0: all that one request stored
  std::string last{};     ///< required prefix of the name of the request that made the change
  /// Conflicts to skip: id and version of each label as a LabelConflict reported it (classes: id
  /// 0). A step blocked by one of these conflicts is passed over, and so are older steps of the
  /// same labels.
  std::vector<std::pair<std::int64_t, std::int64_t>> passed{};
};

}  // namespace roadbook
