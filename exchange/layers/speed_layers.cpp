#include "exchange/layers/speed_layers.hpp"

#include <cmath>

#include "base/error.hpp"
#include "base/text.hpp"
#include "exchange/layers/layer_ages.hpp"
#include "exchange/layers/path_layers.hpp"
#include "exchange/layers/speed_settings.hpp"
#include "exchange/layers/table_row.hpp"
#include "exchange/layers/value_raster.hpp"

namespace roadbook {
namespace {

constexpr const char* kWantSpeeds = "a speed map (roadbook speeds writes it)";

std::string joined_by_comma(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ",") + name;
  return text;
}

VectorLayer cell_layer(const SpeedMap& map) {
  VectorLayer layer;
  layer.name = "dynamic_map";
  layer.description = "Where people are met: probability, and the speed that follows";
  layer.type = GeometryType::kPointZ;
  layer.fields = {{"class", FieldType::kText},          {"prior", FieldType::kReal},
                  {"presence", FieldType::kReal},       {"sigma", FieldType::kReal},
                  {"pedestrian_mps", FieldType::kReal}, {"grip_mps", FieldType::kReal},
                  {"speed_mps", FieldType::kReal},      {"speed_sigma_mps", FieldType::kReal},
                  {"seen_s", FieldType::kReal},         {"person_s", FieldType::kReal},
                  {"visits", FieldType::kInteger},      {"newest_ns", FieldType::kInteger},
                  {"newest_utc", FieldType::kText},     {"coverage", FieldType::kReal},
                  {"sessions", FieldType::kText}};
  const std::string sessions = joined_by_comma(map.sessions);
  const double coverage = map.coverage();
  for (const SpeedCell& cell : map.cells)
    layer.features.push_back(
        {{{cell.centre.x(), cell.centre.y(), 0.0, 0.0}},
         {std::string(to_text(cell.place)), cell.prior, cell.presence, cell.sigma, cell.pedestrian,
          finite_or_null(cell.grip), cell.speed, cell.speed_sigma, cell.seen_s, cell.person_s,
          cell.visits, cell.newest_ns,
          cell.newest_ns > 0 ? FieldValue(utc_text(cell.newest_ns)) : FieldValue{}, coverage,
          sessions}});
  return layer;
}

VectorLayer profile_layer(const SpeedMap& map) {
  VectorLayer layer;
  layer.name = "speed_profile";
  layer.description = "Speed along the lanes that a vehicle can follow, and what limits it";
  layer.type = GeometryType::kPointZ;
  layer.fields = {{"lane", FieldType::kText},
                  {"closed", FieldType::kInteger},
                  {"s_m", FieldType::kReal},
                  {"speed_mps", FieldType::kReal},
                  {"limit_mps", FieldType::kReal},
                  {"pedestrian_mps", FieldType::kReal},
                  {"bend_mps", FieldType::kReal},
                  {"grip_mps", FieldType::kReal},
                  {"grip_mps2", FieldType::kReal},
                  {"presence", FieldType::kReal},
                  {"presence_sigma", FieldType::kReal},
                  {"friction", FieldType::kReal},
                  {"friction_sigma", FieldType::kReal},
                  {"item_mps", FieldType::kReal},
                  {"item_sigma_mps", FieldType::kReal},
                  {"item_grip", FieldType::kReal},
                  {"date_utc", FieldType::kText},
                  {"coverage", FieldType::kReal},
                  {"sessions", FieldType::kText}};
  const std::string sessions = joined_by_comma(map.sessions);
  const std::string date = utc_text(map.date_ns);
  const double coverage = map.coverage();
  for (const LaneProfile& profile : map.profiles)
    for (const LaneSpeed& at : profile.places)
      layer.features.push_back(
          {{{at.position.x(), at.position.y(), 0.0, 0.0}},
           {std::to_string(profile.lane), std::int64_t{profile.closed ? 1 : 0}, at.s_m, at.speed,
            at.limit, finite_or_null(at.pedestrian), finite_or_null(at.bend),
            finite_or_null(at.grip), finite_or_null(at.grip_acceleration),
            finite_or_null(at.presence), finite_or_null(at.presence_sigma),
            finite_or_null(at.friction), finite_or_null(at.friction_sigma), finite_or_null(at.item),
            std::isfinite(at.item) ? FieldValue(at.item_sigma) : FieldValue{}, at.item_grip, date,
            coverage, sessions}});
  return layer;
}

void write_rasters(MapUpdate& update, const SpeedMap& map) {
  Eigen::Vector2d low = map.cells.front().centre;
  Eigen::Vector2d high = low;
  for (const SpeedCell& cell : map.cells) {
    low = low.cwiseMin(cell.centre);
    high = high.cwiseMax(cell.centre);
  }
  const Eigen::Vector2d half = Eigen::Vector2d::Constant(0.5 * map.cell_m);
  ValueRaster speed = ValueRaster::over(low - half, high + half, map.cell_m);
  ValueRaster sigma = speed;
  for (const SpeedCell& cell : map.cells) {
    speed.values[speed.index_of(cell.centre)] = static_cast<float>(cell.speed);
    sigma.values[speed.index_of(cell.centre)] = static_cast<float>(cell.speed_sigma);
  }
  write_value_raster(update, "speed_map", "recommended speed [m/s]", speed);
  write_value_raster(update, "speed_sigma", "standard deviation of the recommended speed [m/s]",
                     sigma);
  write_colour_raster(update, "speed_colours",
                      "recommended speed: dark at the largest, yellow at the smallest", speed,
                      map.options.max_speed, map.options.min_speed);
}

PlaceClass class_from(const TableRow& row) {
  const auto& text = row.get<std::string>("class");
  for (const PlaceClass place :
       {PlaceClass::kCrossing, PlaceClass::kSpace, PlaceClass::kLane, PlaceClass::kOther})
    if (text == to_text(place)) return place;
  row.fail("class", text);
}

void read_cells(const std::string& file, const VectorLayer& layer, SpeedMap& map) {
  for (const Feature& feature : layer.features) {
    const TableRow row(file, layer.name, layer.fields, feature.values, kWantSpeeds);
    if (feature.points.size() != 1) row.fail("geom", "no point");
    map.cells.push_back(
        {feature.points.front().head<2>(), class_from(row), row.get<double>("prior"),
         row.get<double>("presence"), row.get<double>("sigma"), row.get<double>("pedestrian_mps"),
         row.number("grip_mps", INFINITY), row.get<double>("speed_mps"),
         row.get<double>("speed_sigma_mps"), row.get<double>("seen_s"), row.get<double>("person_s"),
         row.get<std::int64_t>("visits"), row.get<std::int64_t>("newest_ns")});
  }
}

void read_profiles(const std::string& file, const VectorLayer& layer, SpeedMap& map) {
  for (const Feature& feature : layer.features) {
    const TableRow row(file, layer.name, layer.fields, feature.values, kWantSpeeds);
    const std::uint64_t lane = row.id("lane");
    if (map.profiles.empty() || map.profiles.back().lane != lane) {
      map.profiles.emplace_back();
      map.profiles.back().lane = lane;
      map.profiles.back().closed = row.get<std::int64_t>("closed") != 0;
    }
    LaneProfile& profile = map.profiles.back();
    LaneSpeed at;
    at.s_m = row.get<double>("s_m");
    at.position = feature.points.front().head<2>();
    at.speed = row.get<double>("speed_mps");
    at.limit = row.get<double>("limit_mps");
    at.pedestrian = row.number("pedestrian_mps", INFINITY);
    at.bend = row.number("bend_mps", INFINITY);
    at.grip = row.number("grip_mps", INFINITY);
    at.grip_acceleration = row.number("grip_mps2", INFINITY);
    at.presence = row.number("presence", NAN);
    at.presence_sigma = row.number("presence_sigma", NAN);
    at.friction = row.number("friction", NAN);
    at.friction_sigma = row.number("friction_sigma", NAN);
    at.item = row.number("item_mps", INFINITY);  // maps of earlier programs have no items
    at.item_sigma = row.number("item_sigma_mps", 0.0);
    at.item_grip = row.number("item_grip", 1.0);
    profile.places.push_back(at);
    if (profile.places.size() == 2) profile.step_m = at.s_m - profile.places[0].s_m;
  }
  for (const LaneProfile& profile : map.profiles)
    if (profile.places.size() < 2 || !(profile.step_m > 0.0))
      throw BadInput(Problem{Severity::kError, file, 0, layer.name,
                             "lane " + std::to_string(profile.lane) + " with no length",
                             kWantSpeeds});
}

}  // namespace

void write_speed_layers(MapUpdate& update, const SpeedMap& map) {
  ROADBOOK_ASSERT(!map.cells.empty());
  update.write_layer(cell_layer(map));
  update.write_layer(profile_layer(map));
  update.write_table(age_table(map.ages, map.now_ns));
  update.write_table(settings_table(map));
  write_rasters(update, map);
}

std::optional<SpeedMap> read_speed_layers(const MapLayers& layers) {
  if (!layers.has("speed_profile")) return std::nullopt;
  SpeedMap map;
  read_settings(layers, map);
  read_cells(layers.file().string(), layers.read_layer("dynamic_map"), map);
  read_profiles(layers.file().string(), layers.read_layer("speed_profile"), map);
  return map;
}

bool speeds_fit(const MapLayers& layers, const std::vector<LanePath>& paths) {
  if (!layers.has("speed_settings")) return true;
  SpeedMap map;
  read_settings(layers, map);
  return map.paths == paths_digest(paths);
}

std::optional<SpeedMap> read_current_speeds(const MapLayers& layers,
                                            const std::vector<LanePath>& paths) {
  if (!speeds_fit(layers, paths))
    throw BadInput(Problem{Severity::kError, layers.file().string(), 0, "speed_profile",
                           "one of other paths than the map has now",
                           "a new one: run `roadbook speeds` on the map"});
  return read_speed_layers(layers);
}

}  // namespace roadbook
