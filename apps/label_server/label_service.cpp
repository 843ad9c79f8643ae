#include "apps/label_server/label_service.hpp"

#include <utility>

#include "apps/label_server/change_request.hpp"
#include "apps/label_server/label_wire.hpp"
#include "apps/label_server/people_wire.hpp"
#include "mapping/layers/map_layers.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostAtOnce = 1000;

}  // namespace

LabelService::LabelService(LabelStore* store,
                           EventHub* hub,
                           const PeopleImages* images,
                           std::vector<LabelClass> classes)
    : store_(store), hub_(hub), images_(images), classes_(store->classes()) {
  if (classes_.version == 0) classes_.classes = std::move(classes);
  for (const LabelEvent& event : store_->events())
    if (event.action != LabelAction::kClasses) entries_[event.label.id].take(event.label);
  std::erase_if(entries_,
                [](const auto& one) { return one.second.label.state == LabelState::kDeleted; });
  for (auto& [id, entry] : entries_) entry.wire = label_to_wire(map(), entry.label).dump();
}

std::string LabelService::list() const {
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

// Two threads may arrive here in another order than the changes were stored. The newer version
// stays.
Json LabelService::told(const Label& label, const std::string& request) {
  Json wire = label_to_wire(map(), label);
  std::string text = wire.dump();
  {
    const std::lock_guard lock(mutex_);
    LabelEntry& entry = entries_[label.id];
    if (entry.label.version < label.version) {
      entry.take(label);
      entry.wire = text;
    }
  }
  Json event = wire;
  event["request"] = request;
  hub_->publish("label", event.dump());
  return wire;
}

// `together`: labels of the same request, before this one.
Label LabelService::read(const Json& body,
                         const std::vector<Label>& together,
                         const Label* previous) const {
  if (previous != nullptr && is_on_ground(*previous) == is_window_on_wire(body))
    throw RequestError(422,
                       "shape: got another kind of shape than the label has (on the ground or in "
                       "an image), want the same kind");
  if (!is_window_on_wire(body)) return label_from_wire(map(), body, previous);
  std::vector<Label> others = image_labels();
  others.insert(others.end(), together.begin(), together.end());
  const LabelAnchor image = previous != nullptr ? previous->anchor : image_from_wire(body);
  std::vector<PersonBox> known;
  for (const Label& other : others)
    if (other.shape == LabelShape::kUpright && other.anchor == image) known.push_back(other.window);
  return window_from_wire(*images_, body, known, previous);
}

Json LabelService::create(const Json& body) {
  const std::string who = who_of(body);
  if (const auto list = body.find("labels"); list != body.end()) {
    if (!list->is_array() || list->empty() || list->size() > kMostAtOnce)
      throw RequestError(422,
                         "labels: got another type or length, want a list of 1 to 1000 labels");
    std::vector<Label> labels;
    for (const Json& label : *list) labels.push_back(read(label, labels));
    return all_told(store_->create_all(labels, who, request_name(body)), request_name(body));
  }
  return told(store_->create(read(body, {}), who, request_name(body)), request_name(body));
}

Json LabelService::change(std::int64_t id, const Json& body) {
  const std::string who = who_of(body);
  const auto previous = store_->find(id);
  if (!previous)
    throw RequestError(404,
                       "label: got " + std::to_string(id) + ", want the id of an existing label");
  if (is_of_another_history(body, previous->version, previous->t_ns))
    throw LabelConflict(*previous);
  // A client that names a version has seen this version. `previous` is the same version or a newer
  // one. If it is newer, there is a conflict.
  Label label = is_on_ground(*previous) && !tells_shape(body)
                    ? with_fields(map(), *previous, body)
                    : read(changed_on_wire(map(), *previous, body), {}, &*previous);
  label.version = integer_field(body, "version");
  return told(store_->change(label, who, request_name(body)), request_name(body));
}

Json LabelService::remove(std::int64_t id, const Json& body) {
  const std::string who = who_of(body);
  const auto previous = store_->find(id);
  if (!previous)
    throw RequestError(404,
                       "label: got " + std::to_string(id) + ", want the id of an existing label");
  if (is_of_another_history(body, previous->version, previous->t_ns))
    throw LabelConflict(*previous);
  const std::string request = request_name(body);
  return told(store_->remove(id, integer_field(body, "version"), who, request), request);
}

Json LabelService::all_told(const std::vector<Label>& labels, const std::string& request) {
  Json list = Json::array();
  for (const Label& label : labels) list.push_back(told(label, request));
  return {{"labels", list}};
}

Json LabelService::undo(const Json& body) {
  return step_told(body, store_->undo(who_of(body), request_name(body), step_of(body)));
}

Json LabelService::redo(const Json& body) {
  return step_told(body, store_->redo(who_of(body), request_name(body), step_of(body)));
}

Json LabelService::step_told(const Json& body, const std::vector<Label>& labels) {
  const std::string request = request_name(body);
  Json answer = all_told(labels, request);
  answer["took"] = store_->taken_by(who_of(body), request);
  return with_classes(std::move(answer));
}

// Adds the classes to the answer to a step, if the step has changed them.
Json LabelService::with_classes(Json answer) {
  const LabelClassList stored = store_->classes();
  {
    const std::lock_guard lock(mutex_);
    if (stored.version <= classes_.version) return answer;
    classes_ = stored;
  }
  const Json wire = classes();
  hub_->publish("classes", wire.dump());
  answer["classes"] = wire;
  return answer;
}

Json LabelService::history(std::size_t count) const {
  const auto all = store_->events();
  Json list = Json::array();
  for (std::size_t i = all.size(); i > 0 && list.size() < count; --i) {
    const LabelEvent& event = all[i - 1];
    list.push_back({{"event", event.event},
                    {"action", to_text(event.action)},
                    {"undoes", event.undoes},
                    {"id", event.label.id},
                    {"kind", event.label.kind},
                    {"version", event.label.version},
                    {"who", event.label.who},
                    {"when", utc_text(event.label.t_ns)}});
  }
  return {{"events", list}};
}

LabelBoxes LabelService::boxes(const std::string& kind) const {
  const std::lock_guard lock(mutex_);
  LabelBoxes boxes;
  for (const auto& [id, entry] : entries_) boxes.add(map(), entry.label, kind);
  return boxes;
}

std::vector<LabelAnswer> LabelService::answers(const std::string& kind) const {
  const std::lock_guard lock(mutex_);
  std::vector<LabelAnswer> answers;
  for (const auto& [id, entry] : entries_)
    if (is_on_ground(entry.label)) entry.add_answer(kind, answers);
  return answers;
}

std::vector<LabelAnswer> LabelService::answers_in_images(const std::string& kind) const {
  const std::lock_guard lock(mutex_);
  std::vector<LabelAnswer> answers;
  for (const auto& [id, entry] : entries_)
    if (entry.label.shape == LabelShape::kUpright) entry.add_answer(kind, answers);
  return answers;
}

std::vector<Label> LabelService::active(bool (*wanted)(const Label&)) const {
  const std::lock_guard lock(mutex_);
  std::vector<Label> labels;
  for (const auto& [id, entry] : entries_)
    if (entry.label.state == LabelState::kActive && wanted(entry.label))
      labels.push_back(entry.label);
  return labels;
}

std::vector<Label> LabelService::ground_labels() const {
  return active([](const Label& l) { return is_on_ground(l) && !is_rejected_kind(l.kind); });
}

std::vector<Label> LabelService::image_labels() const {
  return active([](const Label& l) { return !is_on_ground(l); });
}

std::map<std::string, std::size_t> LabelService::counts() const {
  const std::lock_guard lock(mutex_);
  std::map<std::string, std::size_t> counts;
  for (const auto& [id, entry] : entries_)
    if (entry.label.state == LabelState::kActive && is_on_ground(entry.label))
      ++counts[entry.label.kind];
  return counts;
}

LabelClassList LabelService::shown_classes() const {
  std::vector<std::string> kinds;
  for (const auto& [kind, count] : counts()) kinds.push_back(kind);
  const std::lock_guard lock(mutex_);
  return {with_kinds(classes_.classes, kinds), classes_.version, classes_.who, classes_.t_ns};
}

Json LabelService::classes() const { return classes_to_wire(shown_classes()); }

Json LabelService::set_classes(const Json& body) {
  (void)who_of(body);
  const LabelClassList wanted = classes_from_wire(body);
  const LabelClassList stored = store_->classes();
  if (is_of_another_history(body, stored.version, stored.t_ns)) {
    Label changed;  // id 0: the classes
    changed.version = stored.version;
    changed.who = stored.who;
    throw LabelConflict(changed);
  }
  std::vector<LabelClass> before;
  {
    const std::lock_guard lock(mutex_);
    before = classes_.classes;
  }
  (void)store_->set_classes(before, wanted, request_name(body));
  (void)with_classes(Json::object());
  return {{"classes", classes()}};
}

Json LabelService::conflict(const Label& current, const Json& sent) const {
  const std::string since =
      ": got a change of another version" +
      (current.who.empty() ? "" : " (" + current.who + " has changed it since)") +
      ", want a change of the newest version";
  if (current.id == 0)
    return {{"error", "classes" + since}, {"current", classes()}, {"yours", sent}};
  return {{"error", "label " + std::to_string(current.id) + since},
          {"current", label_to_wire(map(), current)},
          {"yours", sent}};
}

}  // namespace roadbook
