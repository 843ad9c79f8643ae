#include "exchange/layers/item_table.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "exchange/layers/table_row.hpp"

namespace roadbook {
namespace {

constexpr const char* kItemTable = "layer_items";
constexpr const char* kWantItems = "items of layers (roadbook layers writes them)";

PlainTable empty_item_table() {
  PlainTable table;
  table.name = kItemTable;
  table.fields = {{"item", FieldType::kInteger},        {"action", FieldType::kText},
                  {"recorded_ns", FieldType::kInteger}, {"kind", FieldType::kText},
                  {"shape", FieldType::kText},          {"coordinates", FieldType::kText},
                  {"reach_m", FieldType::kReal},        {"observed_ns", FieldType::kInteger},
                  {"half_life_s", FieldType::kReal},    {"speed_mps", FieldType::kReal},
                  {"grip_factor", FieldType::kReal},    {"note", FieldType::kText}};
  return table;
}

FieldValue real_or_null(const std::optional<double>& value) {
  return value ? FieldValue(*value) : FieldValue{};
}

std::vector<FieldValue> row_of(const LayerItem& item) {
  nlohmann::json parts = nlohmann::json::array();
  for (const auto& part : item.parts) {
    nlohmann::json points = nlohmann::json::array();
    for (const Eigen::Vector2d& p : part) points.push_back({p.x(), p.y()});
    parts.push_back(std::move(points));
  }
  return {item.id,
          std::string("put"),
          item.recorded_ns,
          item.kind,
          std::string(to_text(item.shape)),
          parts.dump(),
          item.reach_m,
          item.observed_ns,
          item.half_life_s,
          real_or_null(item.speed),
          real_or_null(item.grip_factor),
          item.note.empty() ? FieldValue{} : FieldValue(item.note)};
}

std::vector<std::vector<Eigen::Vector2d>> parts_from(const TableRow& row) {
  const auto& text = row.get<std::string>("coordinates");
  std::vector<std::vector<Eigen::Vector2d>> parts;
  try {
    for (const auto& points : nlohmann::json::parse(text)) {
      parts.emplace_back();
      for (const auto& p : points)
        parts.back().emplace_back(p.at(0).get<double>(), p.at(1).get<double>());
      if (parts.back().empty()) row.fail("coordinates", "a part without points");
    }
  } catch (const nlohmann::json::exception&) {
    row.fail("coordinates", text.substr(0, 60));
  }
  if (parts.empty()) row.fail("coordinates", "no part");
  for (const auto& part : parts)
    for (const Eigen::Vector2d& p : part)
      if (!(p.cwiseAbs().maxCoeff() <= kFarthestItem_m))
        row.fail("coordinates", text.substr(0, 60));
  return parts;
}

// A number of a column that may be null, within its range.
std::optional<double> optional_number(const TableRow& row, const char* name, double most) {
  const double value = row.number(name, NAN);
  if (std::isnan(value)) return std::nullopt;
  if (!(value >= 0.0 && value <= most)) row.fail(name, std::to_string(value));
  return value;
}

LayerItem item_from(const TableRow& row) {
  LayerItem item;
  item.id = row.get<std::int64_t>("item");
  item.kind = row.get<std::string>("kind");
  if (find_item_kind(item.kind) == nullptr) row.fail("kind", item.kind);
  const auto shape = item_shape(row.get<std::string>("shape"));
  if (!shape) row.fail("shape", row.get<std::string>("shape"));
  item.shape = *shape;
  item.parts = parts_from(row);
  item.reach_m = row.get<double>("reach_m");
  if (!(item.reach_m >= 0.0 && item.reach_m <= kFarthestItem_m))
    row.fail("reach_m", std::to_string(item.reach_m));
  item.observed_ns = row.get<std::int64_t>("observed_ns");
  item.half_life_s = row.get<double>("half_life_s");
  if (!(item.half_life_s > 0.0 && std::isfinite(item.half_life_s)))
    row.fail("half_life_s", std::to_string(item.half_life_s));
  item.speed = optional_number(row, "speed_mps", 100.0);
  item.grip_factor = optional_number(row, "grip_factor", 1.0);
  item.recorded_ns = row.get<std::int64_t>("recorded_ns");
  return item;
}

}  // namespace

void append_items(MapUpdate& update,
                  const MapLayers& before,
                  const std::vector<LayerItem>& put,
                  const std::vector<std::int64_t>& expired,
                  std::int64_t now_ns) {
  if (put.empty() && expired.empty()) return;
  PlainTable table = before.has(kItemTable) ? before.read_table(kItemTable) : empty_item_table();
  for (const LayerItem& item : put) table.rows.push_back(row_of(item));
  for (const std::int64_t id : expired) {
    table.rows.push_back({id, std::string("expire"), now_ns});
    table.rows.back().resize(table.fields.size());
  }
  update.write_table(table);
}

std::vector<LayerItem> read_items(const MapLayers& layers) {
  std::vector<LayerItem> items;
  if (!layers.has(kItemTable)) return items;
  const std::string file = layers.file().string();
  const PlainTable table = layers.read_table(kItemTable);
  for (const auto& values : table.rows) {
    const TableRow row(file, table.name, table.fields, values, kWantItems);
    const auto& action = row.get<std::string>("action");
    const std::int64_t id = row.get<std::int64_t>("item");
    if (action == "put") {
      if (id != static_cast<std::int64_t>(items.size())) row.fail("item", std::to_string(id));
      items.push_back(item_from(row));
      for (std::size_t i = 0; i < values.size(); ++i)
        if (table.fields[i].name == "note" && std::holds_alternative<std::string>(values[i]))
          items.back().note = std::get<std::string>(values[i]);
    } else if (action == "expire") {
      if (id < 0 || id >= static_cast<std::int64_t>(items.size()))
        row.fail("item", std::to_string(id));
      items[static_cast<std::size_t>(id)].expired_ns = row.get<std::int64_t>("recorded_ns");
    } else {
      row.fail("action", action);
    }
  }
  return items;
}

}  // namespace roadbook
