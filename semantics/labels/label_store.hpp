#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "semantics/labels/label_classes.hpp"
#include "semantics/labels/label_conflict.hpp"
#include "semantics/labels/labels.hpp"

namespace roadbook {

struct PlainTable;

// The labels of a map, stored as a log of events in the map file. The state follows from the
// events; no event is overwritten. A call returns when its change is on disk. Changes of threads
// that wait at the same time are written in one transaction.
//
// A store holds the map's lock while it is open: other programs cannot change the map. All
// functions may be called from several threads.

/// Prefix of request names that do not come from the labelling page: labels imported from a file.
inline constexpr const char* kImportRequest = "import/";

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

class LabelStore {
 public:
  /// Opens the labels of a map, or begins them. Throws BadInput if the file is damaged or
  /// incomplete, StorageError if the map is locked or the disk fails.
  explicit LabelStore(const std::filesystem::path& map);
  ~LabelStore();
  LabelStore(const LabelStore&) = delete;
  LabelStore& operator=(const LabelStore&) = delete;

  /// The map as it was when the store was opened.
  [[nodiscard]] const Map& map() const;

  /// Active labels by id; with `deleted`, deleted ones too.
  [[nodiscard]] std::vector<Label> labels(bool deleted = false) const;
  [[nodiscard]] std::optional<Label> find(std::int64_t id) const;
  /// Events with a number above `after`, in order.
  [[nodiscard]] std::vector<LabelEvent> events(std::int64_t after = 0) const;

  /// Stores a new label and returns it as stored; the store assigns id, version and state. A
  /// repeated `request` of the same labeller returns the first result and stores nothing, so a
  /// request may be sent again. An empty request always stores.
  Label create(const Label& label, const std::string& who, const std::string& request = {});
  /// Replaces the label with that id. Throws LabelConflict if the stored version is not
  /// `label.version`. A change of class removes the detector's score (`forget_other_search`).
  Label change(const Label& label, const std::string& who, const std::string& request = {});
  /// Deletes a label. Throws LabelConflict if the stored version is not `version`.
  Label remove(std::int64_t id,
               std::int64_t version,
               const std::string& who,
               const std::string& request = {});

  /// Stores new labels and changes in one transaction, all or none. Throws LabelConflict if the
  /// stored version of a label in `changed` differs.
  std::vector<Label> create_all(const std::vector<Label>& labels,
                                const std::string& who,
                                const std::string& request = {},
                                const std::vector<Label>& changed = {});

  /// Reverts the newest step of `who` that is not reverted yet; `redo` reverts the newest undo. A
  /// step is reverted completely or not at all. Returns the changed labels; empty if there is
  /// nothing to revert. Throws LabelConflict if another labeller changed one of the labels since,
  /// LabelStepElsewhere if the step does not match `step.last`, LabelClassInUse if a class with
  /// labels would vanish.
  std::vector<Label> undo(const std::string& who,
                          const std::string& request = {},
                          const StepBack& step = {});
  std::vector<Label> redo(const std::string& who,
                          const std::string& request = {},
                          const StepBack& step = {});

  /// Name of the request that the given undo or redo request reverted; empty if it reverted none.
  [[nodiscard]] std::string taken_by(const std::string& who, const std::string& request) const;

  /// Replaces the list of classes: table `label_classes` and an event of `wanted.who`, in one
  /// transaction. `before` is the current list if no event recorded one. Returns the new list.
  /// Throws LabelConflict if the stored version is not `wanted.version`, LabelClassInUse if
  /// `wanted` lacks a class that has labels.
  LabelClassList set_classes(const std::vector<LabelClass>& before,
                             const LabelClassList& wanted,
                             const std::string& request = {});
  /// The list of classes after the newest change; empty with version 0 if no event changed it.
  [[nodiscard]] LabelClassList classes() const;

  /// Replaces a plain table of the map (see MapUpdate::write_table) under the store's lock.
  void write_table(const PlainTable& table);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Reads labels of a finished map without locking it. Throws BadInput.
/// Labels of things on the ground:
[[nodiscard]] std::vector<Label> read_labels(const std::filesystem::path& map);
/// Labels of windows in images:
[[nodiscard]] std::vector<Label> read_image_labels(const std::filesystem::path& map);
[[nodiscard]] std::vector<LabelEvent> read_label_events(const std::filesystem::path& map);

}  // namespace roadbook
