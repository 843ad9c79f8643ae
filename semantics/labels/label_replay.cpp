#include "semantics/labels/label_replay.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "mapping/store/map_event_log.hpp"
#include "semantics/labels/label_json.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array kActions{LabelAction::kCreate, LabelAction::kChange, LabelAction::kDelete,
                              LabelAction::kRestore, LabelAction::kClasses};

// An event about classes has no label, so its author and time are fields of the event.
void read_classes(const Json& json, const std::string& source, LabelEvent* event) {
  json.at("version").get_to(event->label.version);
  json.at("who").get_to(event->label.who);
  json.at("t_ns").get_to(event->label.t_ns);
  event->classes = classes_from_json(json.at("classes"), source);
  event->classes_before = classes_from_json(json.at("before"), source);
}

StoredEvent event_of(const std::string& content, std::int64_t number, const std::string& source) {
  StoredEvent stored;
  try {
    const Json json = Json::parse(content);
    const auto name = json.at("action").get<std::string>();
    for (const LabelAction action : kActions)
      if (name == to_text(action)) stored.event.action = action;
    stored.event.undoes = json.at("undoes").get<std::int64_t>();
    stored.request = json.at("request").get<std::string>();
    stored.event.together = json.value("together", false);  // older maps lack this field
    if (stored.event.action == LabelAction::kClasses)
      read_classes(json, source, &stored.event);
    else
      stored.event.label = label_from_json(json.at("label"), source);
  } catch (const Json::exception& fault) {
    throw BadInput({Severity::kError, source, number, "label_events", fault.what(), "an event"});
  }
  stored.event.event = number;
  return stored;
}

// The content of a label: all fields except its version, author, time and the place where a person
// saw it.
Json said_of(const Label& label) {
  Label said = label;
  said.version = 0;
  said.who.clear();
  said.t_ns = 0;
  said.seen.reset();
  return label_to_json(said);
}

}  // namespace

std::string content_of(const StoredEvent& stored) {
  Json json;
  json["action"] = to_text(stored.event.action);
  json["undoes"] = stored.event.undoes;
  json["request"] = stored.request;
  const LabelEvent& event = stored.event;
  if (event.action == LabelAction::kClasses) {
    json["version"] = event.label.version;
    json["who"] = event.label.who;
    json["t_ns"] = event.label.t_ns;
    json["classes"] = classes_to_json(event.classes);
    json["before"] = classes_to_json(event.classes_before);
  } else {
    json["label"] = label_to_json(event.label);
    if (event.together) json["together"] = true;
  }
  return json.dump();
}

LabelReplay::LabelReplay(const std::vector<std::string>& contents, const std::string& source) {
  for (std::size_t i = 0; i < contents.size(); ++i)
    take(event_of(contents[i], static_cast<std::int64_t>(i + 1), source));
}

void LabelReplay::take(const StoredEvent& stored) {
  const LabelEvent& event = stored.event;
  events_.push_back(event);
  requests_of_events_.push_back(stored.request);
  if (event.action == LabelAction::kClasses)
    classes_ = {event.classes, event.label.version, event.label.who, event.label.t_ns};
  else
    labels_[event.label.id] = event.label;
  if (!stored.request.empty()) requests_[{event.label.who, stored.request}].push_back(event.event);
  Stacks& mine = stacks_[event.label.who];
  if (event.undoes == 0) {
    mine.done.push_back(event.event);
    mine.undone.clear();
  } else if (std::erase(mine.done, event.undoes) > 0) {
    mine.undone.push_back(event.event);
  } else {
    std::erase(mine.undone, event.undoes);
    mine.done.push_back(event.event);
  }
}

std::vector<Label> LabelReplay::active(bool deleted_too) const {
  std::vector<Label> list;
  for (const auto& [id, label] : labels_)
    if (deleted_too || label.state == LabelState::kActive) list.push_back(label);
  return list;
}

std::optional<std::vector<Label>> LabelReplay::answer_to(const std::string& who,
                                                         const std::string& request) const {
  const auto found = requests_.find({who, request});
  if (request.empty() || found == requests_.end()) return std::nullopt;
  std::vector<Label> labels;
  for (const std::int64_t number : found->second)
    if (event(number).action != LabelAction::kClasses) labels.push_back(event(number).label);
  return labels;
}

std::string LabelReplay::taken_by(const std::string& who, const std::string& request) const {
  const auto found = requests_.find({who, request});
  if (request.empty() || found == requests_.end()) return {};
  const std::int64_t undone = event(found->second.front()).undoes;
  return undone == 0 ? std::string() : request_of(undone);
}

std::vector<std::int64_t> LabelReplay::last_of(const std::string& who,
                                               bool undone,
                                               std::size_t count,
                                               std::size_t passed) const {
  const auto mine = stacks_.find(who);
  if (mine == stacks_.end()) return {};
  const auto& stack = undone ? mine->second.undone : mine->second.done;
  const auto begin = stack.rbegin() + static_cast<std::ptrdiff_t>(std::min(passed, stack.size()));
  auto end = begin;
  if (count > 0 || begin == stack.rend()) {
    end += std::min(static_cast<std::ptrdiff_t>(count), stack.rend() - begin);
    return {begin, end};
  }
  const std::string& request = request_of(*begin);
  do ++end;
  while (!request.empty() && end != stack.rend() && request_of(*end) == request);
  return {begin, end};
}

std::optional<Label> LabelReplay::before(const LabelEvent& event) const {
  for (std::int64_t e = event.event - 1; e > 0; --e)
    if (this->event(e).label.id == event.label.id) return this->event(e).label;
  return std::nullopt;
}

bool LabelReplay::changed_by_others(const LabelEvent& event, const std::string& who) const {
  const bool touched =
      std::any_of(events_.begin() + event.event, events_.end(), [&](const LabelEvent& later) {
        return later.label.id == event.label.id && later.label.who != who;
      });
  if (!touched) return false;
  if (event.action == LabelAction::kClasses)
    return classes_to_json(classes_.classes) != classes_to_json(event.classes);
  return said_of(labels_.at(event.label.id)) != said_of(event.label);
}

std::vector<Label> read_labels(const std::filesystem::path& map) {
  auto labels = LabelReplay(read_event_log(map, kLabelLog), map.string()).active();
  std::erase_if(labels, [](const Label& label) { return !is_on_ground(label); });
  return labels;
}

std::vector<Label> read_image_labels(const std::filesystem::path& map) {
  auto labels = LabelReplay(read_event_log(map, kLabelLog), map.string()).active();
  std::erase_if(labels, is_on_ground);
  return labels;
}

std::vector<LabelEvent> read_label_events(const std::filesystem::path& map) {
  return LabelReplay(read_event_log(map, kLabelLog), map.string()).events();
}

}  // namespace roadbook
