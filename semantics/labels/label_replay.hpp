#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "semantics/labels/label_event.hpp"

namespace roadbook {

inline constexpr const char* kLabelLog = "label";  ///< event log of the map: table label_events

/// An event of the label log, with the name of the request that caused it.
struct StoredEvent {
  LabelEvent event;
  std::string request;
};

/// JSON text of an event, as stored in the map's event log.
[[nodiscard]] std::string content_of(const StoredEvent& stored);

/// State of the labels after a list of events: labels, classes, and each labeller's undo stack.
class LabelReplay {
 public:
  LabelReplay() = default;
  /// Replays the contents of a log. Throws BadInput naming `source`.
  LabelReplay(const std::vector<std::string>& contents, const std::string& source);

  /// Applies the next event.
  void take(const StoredEvent& stored);

  [[nodiscard]] const std::map<std::int64_t, Label>& labels() const { return labels_; }
  [[nodiscard]] std::vector<Label> active(bool deleted_too = false) const;
  [[nodiscard]] const std::vector<LabelEvent>& events() const { return events_; }
  [[nodiscard]] const LabelEvent& event(std::int64_t number) const {
    return events_.at(static_cast<std::size_t>(number - 1));
  }
  /// Name of the request that caused an event; empty if it had none.
  [[nodiscard]] const std::string& request_of(std::int64_t number) const {
    return requests_of_events_.at(static_cast<std::size_t>(number - 1));
  }
  [[nodiscard]] const LabelClassList& classes() const { return classes_; }
  /// Labels stored by an earlier request of that name; empty if the request is new or unnamed.
  [[nodiscard]] std::optional<std::vector<Label>> answer_to(const std::string& who,
                                                            const std::string& request) const;
  /// Name of the request whose changes the given undo or redo request reverted; empty if it
  /// reverted none.
  [[nodiscard]] std::string taken_by(const std::string& who, const std::string& request) const;
  /// Numbers of the newest `count` events of `who` that can be undone (with `undone`: redone),
  /// newest first, after skipping the `passed` newest. A count of 0 means all events that one
  /// request stored together.
  [[nodiscard]] std::vector<std::int64_t> last_of(const std::string& who,
                                                  bool undone,
                                                  std::size_t count,
                                                  std::size_t passed = 0) const;
  /// The label before an event: as the previous event of the same label left it; empty if none.
  [[nodiscard]] std::optional<Label> before(const LabelEvent& event) const;
  /// True if someone other than `who` changed the event's label (or the list of classes) later, and
  /// the label now differs from what the event stored.
  [[nodiscard]] bool changed_by_others(const LabelEvent& event, const std::string& who) const;

 private:
  struct Stacks {
    std::vector<std::int64_t> done;
    std::vector<std::int64_t> undone;
  };
  std::vector<LabelEvent> events_;
  std::vector<std::string> requests_of_events_;
  std::map<std::int64_t, Label> labels_;
  LabelClassList classes_;
  std::map<std::pair<std::string, std::string>, std::vector<std::int64_t>> requests_;
  std::map<std::string, Stacks> stacks_;
};

}  // namespace roadbook
