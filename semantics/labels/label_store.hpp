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

// The labels of a map as a list of events in the map file: who did what when. What is, is what the
// events say; nothing is overwritten. A change is on the disk when the call returns; changes of
// threads that wait together go there in one transaction.
//
// A store holds the map's lock: other programs that change the map are refused while it is open.
// Safe to use from several threads.

/// What names of requests begin with that no page has made: labels of a file.
inline constexpr const char* kImportRequest = "import/";

/// Classes: the map's classes were changed; the event is about no label.
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
  Label label;  ///< as it stands after the event; of classes: id 0, version, who and when alone
  /// The event that this one takes back; 0: none.
  std::int64_t undoes = 0;
  bool together = false;  ///< it came in a list (create_all), also where that had one label alone
  std::vector<LabelClass> classes{};         ///< after an event that changed them
  std::vector<LabelClass> classes_before{};  ///< and before
};

struct LabelClassList {
  std::vector<LabelClass> classes;
  std::int64_t version = 0;  ///< grows by one with each event; 0: none has changed them
  std::string who;           ///< changed them last
  std::int64_t t_ns = 0;     ///< when, since 1970
};

/// What is to be taken back, or done again.
struct StepBack {
  std::size_t count = 0;  ///< changes; 0: what one request has stored
  std::string last{};     ///< what the name of the request that made the change begins with
  /// Steps that cannot be, as somebody else has changed their labels since, are passed over where
  /// these say so: id and version of each such label, as a LabelConflict told them (classes: id 0).
  /// So are older steps of the same labels.
  std::vector<std::pair<std::int64_t, std::int64_t>> passed{};
};

class LabelStore {
 public:
  /// Opens or begins the labels of MAP. Throws BadInput (damaged, not complete), StorageError
  /// (lock, disk).
  explicit LabelStore(const std::filesystem::path& map);
  ~LabelStore();
  LabelStore(const LabelStore&) = delete;
  LabelStore& operator=(const LabelStore&) = delete;

  /// The map the labels hang on, as it was on opening.
  [[nodiscard]] const Map& map() const;

  /// Active labels by id; with `deleted`, those too.
  [[nodiscard]] std::vector<Label> labels(bool deleted = false) const;
  [[nodiscard]] std::optional<Label> find(std::int64_t id) const;
  /// Events after number `after`, in order.
  [[nodiscard]] std::vector<LabelEvent> events(std::int64_t after = 0) const;

  /// Stores a new label (its id, version and state are given here) and returns it as stored.
  /// `request`: a name the caller made up; the same request again returns what it returned before,
  /// so that one sent twice is stored once. Empty: always new.
  Label create(const Label& label, const std::string& who, const std::string& request = {});
  /// Replaces the label of that id if it stands at `label.version`; LabelConflict otherwise. Given
  /// another class, it is that person's word alone: what a search said, it said of the class
  /// before.
  Label change(const Label& label, const std::string& who, const std::string& request = {});
  /// Deletes it if it stands at `version`.
  Label remove(std::int64_t id,
               std::int64_t version,
               const std::string& who,
               const std::string& request = {});

  /// Stores new labels and changes of others together, all or none. Throws LabelConflict where one
  /// of `changed` does not stand at its version.
  std::vector<Label> create_all(const std::vector<Label>& labels,
                                const std::string& who,
                                const std::string& request = {},
                                const std::vector<Label>& changed = {});

  /// Takes back the last changes (of labels and classes) of `who` that are not taken back yet; redo
  /// takes the last undos back. Together, all or none. The labels they changed, none where there is
  /// nothing to take back; LabelConflict where somebody else has changed one of them since;
  /// LabelStepElsewhere where another request made the change than `step` says; LabelClassInUse.
  std::vector<Label> undo(const std::string& who,
                          const std::string& request = {},
                          const StepBack& step = {});
  std::vector<Label> redo(const std::string& who,
                          const std::string& request = {},
                          const StepBack& step = {});

  /// Name of the request whose step that undo or redo was about; empty where it was about none.
  [[nodiscard]] std::string taken_by(const std::string& who, const std::string& request) const;

  /// Replaces the map's classes if they stand at `wanted.version`, LabelConflict otherwise: table
  /// `label_classes` and an event of `wanted.who`, in one transaction. `before`: what they were, if
  /// no event tells. LabelClassInUse where they lack a class of which there are labels. The classes
  /// then.
  LabelClassList set_classes(const std::vector<LabelClass>& before,
                             const LabelClassList& wanted,
                             const std::string& request = {});
  /// As the last event about them has left them.
  [[nodiscard]] LabelClassList classes() const;

  /// Replaces a plain table of the map (see MapUpdate::write_table), under the lock it holds.
  void write_table(const PlainTable& table);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Labels of a finished map without the lock, for programs that only read. Throws BadInput.
/// Of things on the ground:
[[nodiscard]] std::vector<Label> read_labels(const std::filesystem::path& map);
/// Of windows in images:
[[nodiscard]] std::vector<Label> read_image_labels(const std::filesystem::path& map);
[[nodiscard]] std::vector<LabelEvent> read_label_events(const std::filesystem::path& map);

}  // namespace roadbook
