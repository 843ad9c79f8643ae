#include "semantics/labels/label_diff.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>

#include "base/digest.hpp"
#include "semantics/labels/label_json.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

// A label whose class changes is serialised again. Its pose can then differ in the last bits.
constexpr double kSameNumber = 1e-6;  // [m], [rad]

using Maker = std::tuple<std::int64_t, std::string, std::int64_t>;  // id, who, when

using Events = std::vector<const LabelEvent*>;

// Groups the events by label, in order. The key, a `Maker`, identifies the label.
std::map<Maker, Events> histories(const std::vector<LabelEvent>& events) {
  std::map<std::int64_t, Maker> makers;
  std::map<Maker, Events> all;
  for (const LabelEvent& event : events) {
    if (event.action == LabelAction::kClasses) continue;
    const Label& label = event.label;
    const auto maker = makers.try_emplace(label.id, label.id, label.who, label.t_ns).first;
    all[maker->second].push_back(&event);
  }
  return all;
}

bool is_active(const Events& events) { return events.back()->label.state == LabelState::kActive; }

// The fields that a person can change.
ordered_json fields_of(const Label& label) {
  ordered_json json = label_to_json(label);
  for (const char* name : {"id", "version", "state", "who", "t_ns", "sightings", "seen"})
    json.erase(name);
  if (json.contains("pictures") && !json["pictures"].empty())
    json["pictures"] = sha256_hex(json["pictures"].dump());
  return json;
}

bool is_same_value(const std::string& field, const ordered_json& a, const ordered_json& b) {
  if (a.is_array() && b.is_array())
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [&](const auto& x, const auto& y) { return is_same_value(field, x, y); });
  if (!a.is_number_float() && !b.is_number_float()) return a == b;
  if (!a.is_number() || !b.is_number()) return false;
  const double apart = a.get<double>() - b.get<double>();
  const bool is_angle = field == "heading" || field == "azimuth";
  return std::abs(is_angle ? std::remainder(apart, 2.0 * std::numbers::pi) : apart) <= kSameNumber;
}

ordered_json value_of(const ordered_json& fields, const std::string& name) {
  const auto found = fields.find(name);
  return found == fields.end() ? ordered_json() : *found;
}

// Finds the event that gave the field its present value: the first event of the last run of events
// with that value.
const LabelEvent& giver_of(const Events& events, const std::string& field) {
  const ordered_json now = value_of(fields_of(events.back()->label), field);
  std::size_t first = events.size() - 1;
  while (first > 0 &&
         is_same_value(field, value_of(fields_of(events[first - 1]->label), field), now))
    --first;
  return *events[first];
}

std::vector<LabelFieldChange> field_changes(const Label& from, const Events& now) {
  const ordered_json old_fields = fields_of(from);
  const ordered_json new_fields = fields_of(now.back()->label);
  std::vector<std::string> names;
  for (const auto& [name, value] : new_fields.items()) names.push_back(name);
  for (const auto& [name, value] : old_fields.items())
    if (!new_fields.contains(name)) names.push_back(name);
  std::vector<LabelFieldChange> changes;
  for (const std::string& name : names) {
    const ordered_json a = value_of(old_fields, name);
    const ordered_json b = value_of(new_fields, name);
    if (is_same_value(name, a, b)) continue;
    const LabelEvent& giver = giver_of(now, name);
    changes.push_back({name, a, b, giver.label.who, giver.label.t_ns});
  }
  return changes;
}

LabelDifference said_by(LabelDifferenceKind kind, const Label& label, const LabelEvent& event) {
  return {kind, label, event.label.who, event.label.t_ns, {}};
}

// The last event that deleted or restored the label.
const LabelEvent& last_turn(const Events& events) {
  std::size_t first = events.size() - 1;
  while (first > 0 && events[first - 1]->label.state == events.back()->label.state) --first;
  return *events[first];
}

// Compares the two histories of a label that both maps have.
std::optional<LabelDifference> difference_of(const Events& before, const Events& after) {
  using Kind = LabelDifferenceKind;
  const Label& now = after.back()->label;
  if (!is_active(after)) {
    if (!is_active(before)) return std::nullopt;
    return said_by(Kind::kDeleted, now, last_turn(after));
  }
  auto fields = field_changes(before.back()->label, after);
  if (!is_active(before)) {
    LabelDifference restored = said_by(Kind::kRestored, now, last_turn(after));
    restored.fields = std::move(fields);
    return restored;
  }
  if (fields.empty()) return std::nullopt;
  const auto last = std::max_element(fields.begin(), fields.end(),
                                     [](const auto& a, const auto& b) { return a.t_ns < b.t_ns; });
  return LabelDifference{Kind::kChanged, now, last->who, last->t_ns, fields};
}

}  // namespace

std::vector<LabelDifference> label_differences(const std::vector<LabelEvent>& before,
                                               const std::vector<LabelEvent>& after) {
  const auto old_labels = histories(before);
  const auto new_labels = histories(after);
  std::vector<LabelDifference> all;
  for (const auto& [maker, events] : new_labels) {
    const auto known = old_labels.find(maker);
    if (known != old_labels.end()) {
      if (auto one = difference_of(known->second, events)) all.push_back(std::move(*one));
    } else if (is_active(events)) {
      all.push_back(said_by(LabelDifferenceKind::kAdded, events.back()->label, *events.front()));
    }
  }
  for (const auto& [maker, events] : old_labels)
    if (!new_labels.contains(maker) && is_active(events))
      all.push_back({LabelDifferenceKind::kDeleted, events.back()->label, "", 0, {}});
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.label.id < b.label.id; });
  return all;
}

}  // namespace roadbook
