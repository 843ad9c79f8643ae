#include "workflows/settings/speeds_rules.hpp"

#include <algorithm>
#include <string>

#include "base/error.hpp"
#include "base/yaml.hpp"
#include "exchange/layers/speed_settings.hpp"
#include "exchange/layers/table_row.hpp"

namespace roadbook {

SpeedsRules speeds_rules(const MapLayers& layers,
                         const std::filesystem::path& file,
                         std::optional<double> vehicle_width_m) {
  SpeedsConfig defaults;
  if (vehicle_width_m) defaults.speed.vehicle_width_m = *vehicle_width_m;
  if (!file.empty()) return {SpeedsConfig::load(file, defaults), false};
  if (!layers.has(kSpeedConfigTable)) return {defaults, false};
  const PlainTable table = layers.read_table(kSpeedConfigTable);
  const std::string map = layers.file().string();
  if (table.rows.size() != 1)
    throw BadInput(Problem{Severity::kError, map, 0, table.name,
                           std::to_string(table.rows.size()) + " rows", "one"});
  const TableRow row(map, table.name, table.fields, table.rows.front(),
                     "what `roadbook speeds --config` keeps");
  return {SpeedsConfig::parse(row.get<std::string>("config"), map + " " + table.name, defaults),
          true};
}

void write_speeds_rules(MapUpdate& update, const SpeedsConfig& config) {
  update.write_table({kSpeedConfigTable, {{"config", FieldType::kText}}, {{config.text()}}});
}

std::vector<std::uint64_t> limits_without_lane(const SpeedsConfig& config,
                                               const RoadNetwork& network,
                                               const std::filesystem::path& file,
                                               const std::filesystem::path& map) {
  std::vector<std::uint64_t> gone;
  for (const auto& [lane, limit] : config.limits)
    if (std::none_of(network.lanes.begin(), network.lanes.end(),
                     [id = lane](const Lane& known) { return known.id == id; }))
      gone.push_back(lane);
  if (file.empty() || gone.empty()) return gone;
  std::vector<Problem> problems;
  const auto lines = YamlMap::load(file).map("limits_mps");
  for (const std::uint64_t lane : gone) {
    const std::string id = std::to_string(lane);
    problems.push_back({Severity::kError, file.string(), lines->line(id), "limits_mps", id,
                        "a lane of " + map.string()});
  }
  throw BadInput(problems);
}

}  // namespace roadbook
