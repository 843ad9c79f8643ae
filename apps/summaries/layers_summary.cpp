#include "apps/summaries/layers_summary.hpp"

#include <nlohmann/json.hpp>

#include "base/format.hpp"
#include "mapping/layers/layer_types.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

double age_s(std::int64_t date_ns, std::int64_t now_ns) {
  return 1e-9 * static_cast<double>(now_ns - date_ns);
}

// "2 d", "3.5 h", "12 min" or "40 s".
std::string age_text(double seconds) {
  if (seconds >= 2.0 * 86400.0) return fixed(seconds / 86400.0, 0) + " d";
  if (seconds >= 2.0 * 3600.0) return fixed(seconds / 3600.0, 1) + " h";
  if (seconds >= 120.0) return fixed(seconds / 60.0, 0) + " min";
  return fixed(seconds, 0) + " s";
}

std::string line_of(const AgedItem& aged, std::int64_t now_ns, const std::string& state) {
  const std::string half_life =
      aged.half_life_s > 0.0 ? "half-life " + age_text(aged.half_life_s) : "never fades";
  return aged.name + " (" + to_text(aged.layer()) + "): age " +
         age_text(age_s(aged.date_ns, now_ns)) + ", " + half_life + ", weight " +
         fixed(aged.weight(now_ns), 3) + ", " + state;
}

ordered_json aged_json(const AgedItem& aged, std::int64_t now_ns) {
  return {{"layer", to_text(aged.layer())},
          {"date_utc", utc_text(aged.date_ns)},
          {"age_s", age_s(aged.date_ns, now_ns)},
          {"half_life_s", aged.half_life_s},
          {"weight", aged.weight(now_ns)}};
}

ordered_json number_or_null(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json();
}

}  // namespace

ordered_json item_json(const LayerItem& item, std::int64_t now_ns) {
  ordered_json json{{"item", item.id}, {"kind", item.kind}};
  json.update(aged_json(item.aged(), now_ns));
  json["state"] = to_text(item.state(now_ns));
  json["shape"] = to_text(item.shape);
  json["reach_m"] = item.reach_m;
  json["speed_mps"] = number_or_null(item.speed);
  json["grip_factor"] = number_or_null(item.grip_factor);
  json["note"] = item.note.empty() ? ordered_json() : ordered_json(item.note);
  return json;
}

ordered_json items_json(const std::vector<LayerItem>& items, std::int64_t now_ns) {
  ordered_json used = ordered_json::array();
  ordered_json not_used = ordered_json::array();
  for (const LayerItem& item : items)
    (item.state(now_ns) == ItemState::kUsed ? used : not_used).push_back(item_json(item, now_ns));
  return {{"now_utc", utc_text(now_ns)}, {"used", used}, {"not_used", not_used}};
}

void say_stale_items(const Console& console,
                     const std::vector<LayerItem>& items,
                     std::int64_t now_ns) {
  for (const LayerItem& item : items)
    if (item.state(now_ns) == ItemState::kStale)
      console.note(item.name() + " is stale and not used: weight " + fixed(item.weight(now_ns), 3) +
                   ", below " + fixed(kLeastItemWeight, 1));
}

void print_items(const Console& console, const ItemsResult& result, std::int64_t now_ns) {
  console.warn(result.notes);
  if (result.put + result.already > 0)
    console.say(std::to_string(result.put) + " items put, " + std::to_string(result.already) +
                " were in the map");
  ordered_json items = ordered_json::array();
  for (const LayerItem& item : result.items) {
    const std::string state = to_text(item.state(now_ns));
    const bool unused = item.state(now_ns) != ItemState::kUsed;
    console.say(line_of(item.aged(), now_ns, unused ? state + ": not used" : state));
    items.push_back(item_json(item, now_ns));
  }
  ordered_json layers = ordered_json::array();
  for (const AgedItem& aged : result.ages.all()) {
    const bool stale = aged.stale(now_ns);
    console.say(line_of(aged, now_ns, stale ? "stale" : "fresh"));
    ordered_json json{{"name", aged.name}};
    json.update(aged_json(aged, now_ns));
    json["stale"] = stale;
    layers.push_back(std::move(json));
  }
  console.result({{"now_utc", utc_text(now_ns)},
                  {"put", result.put},
                  {"already", result.already},
                  {"expired", result.expired},
                  {"items", items},
                  {"layers", layers},
                  {"digest", result.digest}});
}

}  // namespace roadbook
