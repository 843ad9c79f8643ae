#include "exchange/layers/speed_settings.hpp"

#include <nlohmann/json.hpp>

#include "base/text.hpp"
#include "exchange/layers/table_row.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::json;

// One list for writing and reading.
template <typename Visit>
void for_each_option(LaneSpeedOptions& options, const Visit& visit) {
  visit("min_speed", options.min_speed);
  visit("max_speed", options.max_speed);
  visit("caution", options.caution);
  visit("grip_quantile", options.grip_quantile);
  visit("grip_share", options.grip_share);
  visit("unknown_grip", options.unknown_grip);
  visit("sight_m", options.sight_m);
  visit("reaction_s", options.reaction_s);
  visit("vehicle_width_m", options.vehicle_width_m);
  visit("step_m", options.step_m);
  visit("acceleration", options.motion.acceleration);
  visit("braking", options.motion.braking);
  visit("lateral", options.motion.lateral);
  visit("jerk", options.motion.jerk);
}

}  // namespace

PlainTable settings_table(const SpeedMap& map) {
  Json json;
  LaneSpeedOptions options = map.options;
  for_each_option(options, [&](const char* name, double value) { json[name] = value; });
  std::string sessions;
  for (const std::string& name : map.sessions) sessions += (sessions.empty() ? "" : ",") + name;
  PlainTable table;
  table.name = "speed_settings";
  table.fields = {{"cell_m", FieldType::kReal},     {"now_ns", FieldType::kInteger},
                  {"date_ns", FieldType::kInteger}, {"sessions", FieldType::kText},
                  {"options", FieldType::kText},    {"paths", FieldType::kText}};
  table.rows.push_back({map.cell_m, map.now_ns, map.date_ns, sessions, json.dump(), map.paths});
  return table;
}

void read_settings(const MapLayers& layers, SpeedMap& map) {
  const std::string file = layers.file().string();
  const PlainTable table = layers.read_table("speed_settings");
  if (table.rows.size() != 1)
    throw BadInput(Problem{Severity::kError, file, 0, table.name,
                           std::to_string(table.rows.size()) + " rows", "one"});
  const TableRow row(file, table.name, table.fields, table.rows.front(), "a speed map");
  map.cell_m = row.get<double>("cell_m");
  map.now_ns = row.get<std::int64_t>("now_ns");
  map.date_ns = row.get<std::int64_t>("date_ns");
  map.paths = row.get<std::string>("paths");
  const auto& sessions = row.get<std::string>("sessions");
  if (!sessions.empty())
    for (const std::string_view name : split(sessions)) map.sessions.emplace_back(name);
  try {
    const Json json = Json::parse(row.get<std::string>("options"));
    for_each_option(map.options,
                    [&](const char* name, double& value) { value = json.at(name).get<double>(); });
  } catch (const Json::exception& error) {
    row.fail("options", error.what());
  }
  map.options.check();
}

}  // namespace roadbook
