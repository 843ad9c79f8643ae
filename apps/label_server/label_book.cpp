#include "apps/label_server/label_book.hpp"

#include <algorithm>

#include "apps/label_server/label_wire.hpp"
#include "mapping/map_layers.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::json;

constexpr std::int64_t kMostUndone = 1000;
constexpr std::size_t kMostAtOnce = 1000;

std::string who_of(const Json& body) {
  const std::string who = text_field(body, "who");
  if (who.empty()) throw RequestError(422, "who: got nothing, want a name");
  return who;
}

std::string request_of(const Json& body) {
  return body.contains("request") ? text_field(body, "request") : std::string();
}

std::size_t count_of(const Json& body) {
  const std::int64_t count = body.contains("count") ? integer_field(body, "count") : 0;
  if (count < 0 || count > kMostUndone)
    throw RequestError(422, "count: got " + std::to_string(count) + ", want 0 to 1000");
  return static_cast<std::size_t>(count);
}

const char* action_name(LabelAction action) {
  switch (action) {
    case LabelAction::kCreate:
      return "create";
    case LabelAction::kChange:
      return "change";
    case LabelAction::kDelete:
      return "delete";
    case LabelAction::kRestore:
      return "restore";
  }
  return "";
}

}  // namespace

LabelBook::LabelBook(LabelStore* store, EventHub* hub, std::vector<LabelClass> classes)
    : store_(store), hub_(hub), classes_(std::move(classes)) {
  for (const Label& label : store_->labels())
    entries_[label.id] = {label, label_to_wire(map(), label).dump()};
}

std::string LabelBook::list() const {
  const std::lock_guard lock(mutex_);
  std::string text = "{\"labels\":[";
  bool first = true;
  for (const auto& [id, entry] : entries_) {
    if (entry.label.state == LabelState::kDeleted) continue;
    text += (first ? "" : ",") + entry.wire;
    first = false;
  }
  return text + "]}";
}

// Two threads may come here in another order than they were stored: the newer version stays.
Json LabelBook::told(const Label& label) {
  Json wire = label_to_wire(map(), label);
  std::string text = wire.dump();
  {
    const std::lock_guard lock(mutex_);
    Entry& entry = entries_[label.id];
    if (entry.label.version < label.version) entry = {label, text};
  }
  hub_->publish("label", text);
  return wire;
}

Json LabelBook::create(const Json& body) {
  const std::string who = who_of(body);
  if (const auto list = body.find("labels"); list != body.end()) {
    if (!list->is_array() || list->empty() || list->size() > kMostAtOnce)
      throw RequestError(422, "labels: got another list, want 1 to 1000");
    std::vector<Label> labels;
    for (const Json& label : *list) labels.push_back(label_from_wire(map(), label));
    return all_told(store_->create_all(labels, who, request_of(body)));
  }
  return told(store_->create(label_from_wire(map(), body), who, request_of(body)));
}

Json LabelBook::change(std::int64_t id, const Json& body) {
  const std::string who = who_of(body);
  const auto previous = store_->find(id);
  if (!previous)
    throw RequestError(404, "label: got " + std::to_string(id) + ", want one there is");
  Label label = label_from_wire(map(), body, &*previous);
  label.version = integer_field(body, "version");
  return told(store_->change(label, who, request_of(body)));
}

Json LabelBook::remove(std::int64_t id, const Json& body) {
  const std::string who = who_of(body);
  if (!store_->find(id))
    throw RequestError(404, "label: got " + std::to_string(id) + ", want one there is");
  return told(store_->remove(id, integer_field(body, "version"), who, request_of(body)));
}

Json LabelBook::all_told(const std::vector<Label>& labels) {
  Json list = Json::array();
  for (const Label& label : labels) list.push_back(told(label));
  return {{"labels", list}};
}

Json LabelBook::undo(const Json& body) {
  return all_told(store_->undo(who_of(body), count_of(body), request_of(body)));
}

Json LabelBook::redo(const Json& body) {
  return all_told(store_->redo(who_of(body), count_of(body), request_of(body)));
}

Json LabelBook::history(std::size_t count) const {
  const auto all = store_->events();
  Json list = Json::array();
  for (std::size_t i = all.size(); i > 0 && list.size() < count; --i) {
    const LabelEvent& event = all[i - 1];
    list.push_back({{"event", event.event},
                    {"action", action_name(event.action)},
                    {"undoes", event.undoes},
                    {"id", event.label.id},
                    {"kind", event.label.kind},
                    {"version", event.label.version},
                    {"who", event.label.who},
                    {"when", utc_text(event.label.t_ns)}});
  }
  return {{"events", list}};
}

LabelBook::Examples LabelBook::examples(const std::string& kind) const {
  const std::lock_guard lock(mutex_);
  Examples examples;
  for (const auto& [id, entry] : entries_) {
    if (entry.label.state == LabelState::kDeleted) continue;
    const bool is_positive = entry.label.kind == kind;
    if (!is_positive && entry.label.kind != rejected_kind(kind)) continue;
    const auto box = box_in_map(map(), entry.label);
    if (box) (is_positive ? examples.positives : examples.negatives).push_back(*box);
  }
  return examples;
}

LabelBook::Answers LabelBook::answers(const std::string& kind,
                                      double least,
                                      std::int64_t from_ns,
                                      std::int64_t to_ns) const {
  const std::lock_guard lock(mutex_);
  Answers answers;
  for (const auto& [id, entry] : entries_) {
    const Label& label = entry.label;
    if (label.state == LabelState::kDeleted || label.t_ns < from_ns || label.t_ns >= to_ns ||
        label.score < least)
      continue;
    if (label.kind == kind && label.source == LabelSource::kAccepted) ++answers.accepted;
    if (label.kind == rejected_kind(kind)) ++answers.rejected;
  }
  return answers;
}

std::map<std::string, std::size_t> LabelBook::counts() const {
  const std::lock_guard lock(mutex_);
  std::map<std::string, std::size_t> counts;
  for (const auto& [id, entry] : entries_)
    if (entry.label.state == LabelState::kActive) ++counts[entry.label.kind];
  return counts;
}

Json LabelBook::classes() const {
  std::vector<std::string> kinds;
  for (const auto& [kind, count] : counts()) kinds.push_back(kind);
  const std::lock_guard lock(mutex_);
  return classes_to_wire(with_kinds(classes_, kinds));
}

Json LabelBook::set_classes(const Json& body) {
  static_cast<void>(who_of(body));
  const auto classes = classes_from_wire(body);
  for (const auto& [kind, count] : counts()) {
    const bool kept = is_rejected_kind(kind) || std::any_of(classes.begin(), classes.end(),
                                                            [&, &name = kind](const LabelClass& c) {
                                                              return c.kind == name;
                                                            });
    if (!kept)
      throw RequestError(422, "classes: got no " + kind + ", want it while there are labels of it");
  }
  store_->write_table(label_class_table(classes));
  {
    const std::lock_guard lock(mutex_);
    classes_ = classes;
  }
  const Json wire = {{"classes", this->classes()}};
  hub_->publish("classes", wire.dump());
  return wire;
}

Json LabelBook::conflict(const Label& current, const Json& sent) const {
  return {{"error", "label " + std::to_string(current.id) + " was changed by " + current.who},
          {"current", label_to_wire(map(), current)},
          {"yours", sent}};
}

}  // namespace roadbook
