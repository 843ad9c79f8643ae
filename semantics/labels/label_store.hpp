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
#include "semantics/labels/label_event.hpp"
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
  /// nothing to revert. Throws LabelConflict, LabelStepElsewhere or LabelClassInUse
  /// (semantics/labels/label_conflict.hpp).
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
