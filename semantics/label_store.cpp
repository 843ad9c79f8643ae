#include "semantics/label_store.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <utility>

#include "mapping/map_event_log.hpp"
#include "mapping/map_file.hpp"
#include "semantics/label_json.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kLog = "label";

constexpr std::array<std::pair<LabelAction, const char*>, 4> kActions{
    {{LabelAction::kCreate, "create"},
     {LabelAction::kChange, "change"},
     {LabelAction::kDelete, "delete"},
     {LabelAction::kRestore, "restore"}}};

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

struct StoredEvent {
  LabelEvent event;
  std::string request;
};

std::string content_of(const StoredEvent& stored) {
  Json json;
  for (const auto& [action, name] : kActions)
    if (action == stored.event.action) json["action"] = name;
  json["undoes"] = stored.event.undoes;
  json["request"] = stored.request;
  json["label"] = label_to_json(stored.event.label);
  return json.dump();
}

StoredEvent event_of(const std::string& content, std::int64_t number, const std::string& source) {
  StoredEvent stored;
  try {
    const Json json = Json::parse(content);
    const auto name = json.at("action").get<std::string>();
    for (const auto& [action, known] : kActions)
      if (name == known) stored.event.action = action;
    stored.event.undoes = json.at("undoes").get<std::int64_t>();
    stored.request = json.at("request").get<std::string>();
    stored.event.label = label_from_json(json.at("label"), source);
  } catch (const Json::exception& fault) {
    throw BadInput({Severity::kError, source, number, "label_events", fault.what(), "an event"});
  }
  stored.event.event = number;
  return stored;
}

// What the events say: labels as they stand, and what each person may take back.
class Replay {
 public:
  void take(const StoredEvent& stored) {
    const LabelEvent& event = stored.event;
    events_.push_back(event);
    labels_[event.label.id] = event.label;
    if (!stored.request.empty()) requests_[{event.label.who, stored.request}] = event.event;
    Stacks& mine = stacks_[event.label.who];
    if (event.undoes == 0) {
      mine.done.push_back(event.event);
      mine.undone.clear();
    } else if (!mine.done.empty() && mine.done.back() == event.undoes) {
      mine.done.pop_back();
      mine.undone.push_back(event.event);
    } else {
      std::erase(mine.undone, event.undoes);
      mine.done.push_back(event.event);
    }
  }
  [[nodiscard]] const std::map<std::int64_t, Label>& labels() const { return labels_; }
  [[nodiscard]] const std::vector<LabelEvent>& events() const { return events_; }
  [[nodiscard]] const LabelEvent& event(std::int64_t number) const {
    return events_.at(static_cast<std::size_t>(number - 1));
  }
  [[nodiscard]] std::optional<Label> answer_to(const std::string& who,
                                               const std::string& request) const {
    const auto found = requests_.find({who, request});
    if (request.empty() || found == requests_.end()) return std::nullopt;
    return event(found->second).label;
  }
  [[nodiscard]] std::int64_t last_done(const std::string& who) const {
    const auto mine = stacks_.find(who);
    return mine == stacks_.end() || mine->second.done.empty() ? 0 : mine->second.done.back();
  }
  [[nodiscard]] std::int64_t last_undone(const std::string& who) const {
    const auto mine = stacks_.find(who);
    return mine == stacks_.end() || mine->second.undone.empty() ? 0 : mine->second.undone.back();
  }
  /// The label as it stood before an event: of the event before it on the same label.
  [[nodiscard]] std::optional<Label> before(const LabelEvent& event) const {
    for (std::int64_t e = event.event - 1; e > 0; --e)
      if (this->event(e).label.id == event.label.id) return this->event(e).label;
    return std::nullopt;
  }
  /// Whether anybody but `who` has changed the label of an event since.
  [[nodiscard]] bool touched_by_others(const LabelEvent& event, const std::string& who) const {
    return std::any_of(events_.begin() + event.event, events_.end(), [&](const LabelEvent& later) {
      return later.label.id == event.label.id && later.label.who != who;
    });
  }

 private:
  struct Stacks {
    std::vector<std::int64_t> done;
    std::vector<std::int64_t> undone;
  };
  std::vector<LabelEvent> events_;
  std::map<std::int64_t, Label> labels_;
  std::map<std::pair<std::string, std::string>, std::int64_t> requests_;
  std::map<std::string, Stacks> stacks_;
};

Replay replay_of(const std::vector<std::string>& contents, const std::string& source) {
  Replay replay;
  for (std::size_t i = 0; i < contents.size(); ++i)
    replay.take(event_of(contents[i], static_cast<std::int64_t>(i + 1), source));
  return replay;
}

std::vector<Label> labels_of(const Replay& replay, bool deleted) {
  std::vector<Label> labels;
  for (const auto& [id, label] : replay.labels())
    if (deleted || label.state == LabelState::kActive) labels.push_back(label);
  return labels;
}

}  // namespace

LabelConflict::LabelConflict(Label current_label)
    : Error(ExitStatus::kRefused,
            "error: label " + std::to_string(current_label.id) + ": version: got another, want " +
                std::to_string(current_label.version)),
      current(std::move(current_label)) {}

struct LabelStore::Impl {
  explicit Impl(const std::filesystem::path& path)
      : log(path, kLog), map(load_map(path)), file(path.string()) {
    replay = replay_of(log.events(), file);
  }

  // Under the mutex. On the disk first: what is in memory is what has been stored.
  Label store(LabelAction action,
              Label label,
              const std::string& who,
              const std::string& request,
              std::int64_t undoes = 0) {
    label.who = who;
    label.t_ns = now_ns();
    StoredEvent stored{{0, action, std::move(label), undoes}, request};
    stored.event.event = log.append(content_of(stored));
    replay.take(stored);
    return stored.event.label;
  }
  const Label& at_version(std::int64_t id, std::int64_t version) const {
    const auto found = replay.labels().find(id);
    if (found == replay.labels().end())
      throw BadInput(
          {Severity::kError, file, 0, "label", std::to_string(id), "a label of this map"});
    if (found->second.version != version) throw LabelConflict(found->second);
    return found->second;
  }
  // Puts a label back to what it was before event `number`, if nobody has changed it since.
  Label take_back(std::int64_t number, const std::string& who) {
    const LabelEvent event = replay.event(number);
    const Label now = replay.labels().at(event.label.id);
    if (replay.touched_by_others(event, who)) throw LabelConflict(now);
    const auto before = replay.before(event);
    Label label = before ? *before : now;
    if (!before) label.state = LabelState::kDeleted;
    label.version = now.version + 1;
    const LabelAction action = label.state == LabelState::kDeleted ? LabelAction::kDelete
                               : now.state == LabelState::kDeleted ? LabelAction::kRestore
                                                                   : LabelAction::kChange;
    return store(action, std::move(label), who, {}, number);
  }

  mutable std::mutex mutex;
  MapEventLog log;
  Map map;
  std::string file;
  Replay replay;
};

LabelStore::LabelStore(const std::filesystem::path& map) : impl_(std::make_unique<Impl>(map)) {}
LabelStore::~LabelStore() = default;

const Map& LabelStore::map() const { return impl_->map; }

std::vector<Label> LabelStore::labels(bool deleted) const {
  const std::scoped_lock lock(impl_->mutex);
  return labels_of(impl_->replay, deleted);
}

std::optional<Label> LabelStore::find(std::int64_t id) const {
  const std::scoped_lock lock(impl_->mutex);
  const auto found = impl_->replay.labels().find(id);
  if (found == impl_->replay.labels().end()) return std::nullopt;
  return found->second;
}

std::vector<LabelEvent> LabelStore::events(std::int64_t after) const {
  const std::scoped_lock lock(impl_->mutex);
  const auto& all = impl_->replay.events();
  const auto first = std::clamp<std::int64_t>(after, 0, static_cast<std::int64_t>(all.size()));
  return {all.begin() + first, all.end()};
}

Label LabelStore::create(Label label, const std::string& who, const std::string& request) {
  check_label(label, "label");
  const std::scoped_lock lock(impl_->mutex);
  if (auto answered = impl_->replay.answer_to(who, request)) return *answered;
  if (!keyframe_of(impl_->map, label.anchor))
    throw BadInput({Severity::kError, impl_->file, 0, "anchor", std::to_string(label.anchor.t_ns),
                    "a keyframe of the map"});
  const auto& labels = impl_->replay.labels();
  label.id = labels.empty() ? 1 : labels.rbegin()->first + 1;
  label.version = 1;
  label.state = LabelState::kActive;
  return impl_->store(LabelAction::kCreate, std::move(label), who, request);
}

Label LabelStore::change(Label label, const std::string& who, const std::string& request) {
  check_label(label, "label");
  const std::scoped_lock lock(impl_->mutex);
  if (auto answered = impl_->replay.answer_to(who, request)) return *answered;
  const Label& now = impl_->at_version(label.id, label.version);
  if (!keyframe_of(impl_->map, label.anchor))
    throw BadInput({Severity::kError, impl_->file, 0, "anchor", std::to_string(label.anchor.t_ns),
                    "a keyframe of the map"});
  const bool restored = now.state == LabelState::kDeleted;
  label.state = LabelState::kActive;
  ++label.version;
  return impl_->store(restored ? LabelAction::kRestore : LabelAction::kChange, std::move(label),
                      who, request);
}

Label LabelStore::remove(std::int64_t id,
                         std::int64_t version,
                         const std::string& who,
                         const std::string& request) {
  const std::scoped_lock lock(impl_->mutex);
  if (auto answered = impl_->replay.answer_to(who, request)) return *answered;
  Label label = impl_->at_version(id, version);
  label.state = LabelState::kDeleted;
  ++label.version;
  return impl_->store(LabelAction::kDelete, std::move(label), who, request);
}

std::optional<Label> LabelStore::undo(const std::string& who) {
  const std::scoped_lock lock(impl_->mutex);
  const std::int64_t number = impl_->replay.last_done(who);
  if (number == 0) return std::nullopt;
  return impl_->take_back(number, who);
}

std::optional<Label> LabelStore::redo(const std::string& who) {
  const std::scoped_lock lock(impl_->mutex);
  const std::int64_t number = impl_->replay.last_undone(who);
  if (number == 0) return std::nullopt;
  return impl_->take_back(number, who);
}

std::vector<Label> read_labels(const std::filesystem::path& map) {
  return labels_of(replay_of(read_event_log(map, kLog), map.string()), false);
}

}  // namespace roadbook
