#include "exchange/layers/layer_ages.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include "exchange/layers/table_row.hpp"
#include "mapping/layers/parse_utc.hpp"

namespace roadbook {
namespace {

constexpr const char* kAgeTable = "layer_ages";

std::vector<FieldValue> age_row(const AgedItem& item, std::int64_t now_ns) {
  return {item.name,
          std::string(to_text(item.layer())),
          utc_text(item.date_ns),
          item.half_life_s,
          item.weight(now_ns),
          std::int64_t{item.stale(now_ns) ? 1 : 0}};
}

bool is_row_of(const std::vector<FieldValue>& values, const std::string& item) {
  return !values.empty() && values.front() == FieldValue(item);
}

// True for the rows that follow that of the raster in the order of `speeds`: later rasters, then
// the speed map. The same work in another order of verbs gives the same table.
bool is_after(const std::vector<FieldValue>& values, const std::string& raster) {
  const auto own = std::find(std::begin(kRastersWithAge), std::end(kRastersWithAge), raster);
  return is_row_of(values, "speed_map") ||
         std::any_of(own, std::end(kRastersWithAge),
                     [&](const char* later) { return is_row_of(values, later); });
}

}  // namespace

PlainTable age_table(const AgedLayers& ages, std::int64_t now_ns) {
  PlainTable table;
  table.name = kAgeTable;
  table.fields = {{"item", FieldType::kText},     {"layer", FieldType::kText},
                  {"date_utc", FieldType::kText}, {"half_life_s", FieldType::kReal},
                  {"weight", FieldType::kReal},   {"stale", FieldType::kInteger}};
  for (const AgedItem& item : ages.all()) table.rows.push_back(age_row(item, now_ns));
  return table;
}

void write_raster_age(MapUpdate& update,
                      const MapLayers& before,
                      const AgedItem& raster,
                      std::int64_t now_ns) {
  PlainTable table = age_table({}, now_ns);
  if (before.has(kAgeTable)) table.rows = before.read_table(kAgeTable).rows;
  std::erase_if(table.rows, [&](const auto& values) { return is_row_of(values, raster.name); });
  AgedItem written = raster;
  written.date_ns = parse_utc(utc_text(raster.date_ns)).value_or(raster.date_ns);  // as read again
  const auto place = std::find_if(table.rows.begin(), table.rows.end(), [&](const auto& values) {
    return is_after(values, raster.name);
  });
  table.rows.insert(place, age_row(written, now_ns));
  update.write_table(table);
}

AgedLayers read_layer_ages(const MapLayers& layers) {
  AgedLayers ages;
  if (!layers.has(kAgeTable)) return ages;
  const std::string file = layers.file().string();
  const PlainTable table = layers.read_table(kAgeTable);
  for (const auto& values : table.rows) {
    const TableRow row(file, table.name, table.fields, values, "ages of layers");
    const auto date = parse_utc(row.get<std::string>("date_utc"));
    if (!date) row.fail("date_utc", row.get<std::string>("date_utc"));
    const double half_life = row.get<double>("half_life_s");
    if (!(half_life >= 0.0 && std::isfinite(half_life)))
      row.fail("half_life_s", std::to_string(half_life));
    ages.put({row.get<std::string>("item"), *date, half_life});
  }
  return ages;
}

}  // namespace roadbook
