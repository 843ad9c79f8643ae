#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "semantics/labels/label_store.hpp"

namespace roadbook {

inline constexpr const char* kLabelLog = "label";  ///< of the map: table label_events

/// An event of the labels' log, and the name of the request that asked for it.
struct StoredEvent {
  LabelEvent event;
  std::string request;
};

/// As it stands in the map's list of events.
[[nodiscard]] std::string content_of(const StoredEvent& stored);

/// What the events of a log say: labels as they stand, and what each person may take back.
class LabelReplay {
 public:
  LabelReplay() = default;
  /// Of a log's contents. Throws BadInput naming `source`.
  LabelReplay(const std::vector<std::string>& contents, const std::string& source);

  /// The next event.
  void take(const StoredEvent& stored);

  [[nodiscard]] const std::map<std::int64_t, Label>& labels() const { return labels_; }
  [[nodiscard]] std::vector<Label> active(bool deleted_too = false) const;
  [[nodiscard]] const std::vector<LabelEvent>& events() const { return events_; }
  [[nodiscard]] const LabelEvent& event(std::int64_t number) const {
    return events_.at(static_cast<std::size_t>(number - 1));
  }
  /// Name of the request that asked for an event; empty where it had none.
  [[nodiscard]] const std::string& request_of(std::int64_t number) const {
    return requests_of_events_.at(static_cast<std::size_t>(number - 1));
  }
  [[nodiscard]] const LabelClassList& classes() const { return classes_; }
  /// Labels that a request has stored; empty where it is new or has no name.
  [[nodiscard]] std::optional<std::vector<Label>> answer_to(const std::string& who,
                                                            const std::string& request) const;
  /// Name of the request whose changes that request has taken back or done again; empty where it
  /// has not.
  [[nodiscard]] std::string taken_by(const std::string& who, const std::string& request) const;
  /// Numbers of the last `count` events of `who` that can be taken back (or, for `undone`, whose
  /// taking back can), newest first, but for the `passed` newest; with a count of 0 those that one
  /// request has stored together.
  [[nodiscard]] std::vector<std::int64_t> last_of(const std::string& who,
                                                  bool undone,
                                                  std::size_t count,
                                                  std::size_t passed = 0) const;
  /// The label as it stood before an event: of the event before it on the same label.
  [[nodiscard]] std::optional<Label> before(const LabelEvent& event) const;
  /// Whether anybody but `who` has changed the label (or the classes) of an event since, and it
  /// does not stand again as the event has left it.
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
