#include "workflows/make_speeds.hpp"

#include <algorithm>

#include "exchange/layers/friction_layers.hpp"
#include "exchange/layers/item_table.hpp"
#include "exchange/layers/layer_ages.hpp"
#include "exchange/layers/network_layers.hpp"
#include "exchange/layers/path_layers.hpp"
#include "exchange/layers/speed_layers.hpp"
#include "exchange/layers/stored_paths.hpp"
#include "mapping/pieces.hpp"
#include "mapping/session_car.hpp"
#include "mapping/store/map_file.hpp"
#include "semantics/labels/label_layers.hpp"
#include "semantics/labels/label_store.hpp"
#include "workflows/people/truth_scene.hpp"
#include "workflows/session_drives.hpp"
#include "workflows/settings/speeds_rules.hpp"

namespace roadbook {
namespace {

std::vector<Outline> outlines_of(const MapLayers& layers,
                                 const std::vector<VectorLayer>& labels,
                                 const std::string& name) {
  std::vector<Outline> outlines;
  const auto found = layer_of_today(layers, labels, name);
  if (!found) return outlines;
  const VectorLayer& layer = *found;
  if (layer.type != GeometryType::kPolygonZ)
    throw BadInput(
        Problem{Severity::kError, layers.file().string(), 0, name, "no polygons", "polygons"});
  for (const Feature& feature : layer.features) {
    Outline outline;
    for (const Eigen::Vector4d& p : feature.points) outline.emplace_back(p.head<2>());
    outlines.push_back(std::move(outline));
  }
  return outlines;
}

// Adds a layer of outlines, unless the map already has a layer of this name.
void keep_outlines(MapUpdate& update,
                   const std::filesystem::path& map,
                   const std::string& name,
                   const std::vector<Outline>& outlines) {
  if (outlines.empty() || MapLayers(map).has(name)) return;
  VectorLayer layer;
  layer.name = name;
  layer.description = "Outlines from the truth of a simulated drive";
  layer.type = GeometryType::kPolygonZ;
  layer.fields = {{"source", FieldType::kText}};
  for (const Outline& outline : outlines) {
    Feature feature;
    for (const Eigen::Vector2d& p : outline) feature.points.emplace_back(p.x(), p.y(), 0.0, 0.0);
    if (!outline.empty() && outline.front() != outline.back())
      feature.points.push_back(feature.points.front());
    feature.values = {std::string("truth")};
    layer.features.push_back(std::move(feature));
  }
  update.write_layer(layer);
}

void add(MergeCount& sum, const MergeCount& one) {
  sum.added += one.added;
  sum.known += one.known;
  sum.replaced += one.replaced;
}

void take_tables(const SpeedsRequest& request,
                 const Map& map,
                 SpeedSources& sources,
                 DetectionsTaken& taken) {
  std::vector<Detection> detections;
  for (const auto& file : request.detections) {
    const auto rows = read_detections(file);
    if (rows.empty()) taken.empty_tables.push_back(file.string());
    detections.insert(detections.end(), rows.begin(), rows.end());
  }
  taken.tables = merge_sightings(
      sources.sightings, by_session(map, detections, request.observed, taken.without_session), map,
      request.replace);
}

// The truth is complete. It replaces all earlier sightings of its sessions.
void take_truth(const Map& map,
                const std::filesystem::path& file,
                double range_m,
                SpeedSources& sources,
                DetectionsTaken& taken) {
  for (std::size_t i = 0; i < map.sessions.size(); ++i) {
    TruthScene scene =
        read_truth_scene(map, static_cast<int>(i), session_folder(file, map.sessions[i]), range_m);
    add(taken.truth, merge_sightings(sources.sightings, {std::move(scene.sightings)}, map, true));
    if (sources.spaces.empty()) sources.spaces = std::move(scene.spaces);
    if (sources.crossings.empty()) sources.crossings = std::move(scene.crossings);
  }
}

SpeedSources sources_of(const SpeedsRequest& request,
                        const Map& map,
                        const SpeedsConfig& config,
                        DetectionsTaken& taken) {
  const MapLayers layers(request.map);
  require_paths(layers);
  SpeedSources sources;
  sources.network = read_network_layers(layers);
  sources.paths = read_path_layers(layers);
  const auto labels = label_layers_of_today(layers);
  sources.spaces = outlines_of(layers, labels, "parking_spaces");
  sources.crossings = outlines_of(layers, labels, "crossings");
  sources.friction = read_friction_layers(layers, sources.paths);
  sources.items = read_items(layers);
  sources.sightings = stored_sightings(layers, map);
  take_tables(request, map, sources, taken);
  if (request.truth) take_truth(map, request.map, config.sight.range_m, sources, taken);
  return sources;
}

// The time for which the request wants the speed map.
std::int64_t time_of(const SpeedsRequest& request,
                     const Map& map,
                     const std::vector<LayerItem>& items) {
  std::int64_t newest_ns = 0;
  for (const Session& session : map.sessions) newest_ns = std::max(newest_ns, session.t_end_ns);
  return request.now_ns.value_or(time_of_items(items, newest_ns)) +
         static_cast<std::int64_t>(request.days_later * 86400.0) * 1'000'000'000;
}

// Ages of the items of layers and of the map's rasters, which `make_speed_map` does not know.
void add_other_ages(const MapLayers& layers, double speed_half_life_s, SpeedsResult& result) {
  SpeedMap& speeds = result.speeds;
  for (const LayerItem& item : result.items)
    if (item.state(speeds.now_ns) != ItemState::kExpired) speeds.ages.put(item.aged());
  const AgedLayers known = read_layer_ages(layers);
  for (const char* raster : kRastersWithAge)
    if (const AgedItem* aged = known.find(raster)) speeds.ages.put(*aged);
  speeds.ages.put({"speed_map", speeds.date_ns, speed_half_life_s});
}

}  // namespace

SpeedsResult make_speeds(const SpeedsRequest& request) {
  MapUpdate update(request.map);  // locks the map between reading and writing
  const Map map = load_joined_map(request.map);
  SpeedsResult result;
  const auto [config, kept] =
      speeds_rules(MapLayers(request.map), request.config, vehicle_width_m(map));
  result.config_kept = kept;
  SpeedSources sources = sources_of(request, map, config, result.taken);
  write_label_layers(update, MapLayers(request.map), map, read_labels(request.map));
  result.limits_lost = limits_without_lane(config, sources.network, request.config, request.map);
  // Places from the truth stay in the map, for a later run without the truth.
  if (request.truth) {
    keep_outlines(update, request.map, "parking_spaces", sources.spaces);
    keep_outlines(update, request.map, "crossings", sources.crossings);
  }
  const std::vector<SessionSightings> sightings = sources.sightings;
  result.items = sources.items;
  const std::int64_t now_ns = time_of(request, map, result.items);
  const auto earlier = request.local ? read_speed_layers(MapLayers(request.map)) : std::nullopt;
  LocalUpdate local{earlier ? &*earlier : nullptr, 0};
  result.speeds = make_speed_map(map, std::move(sources), config, now_ns, result.visits,
                                 earlier ? &local : nullptr);
  add_other_ages(MapLayers(request.map), config.visit_half_life_days * 86400.0, result);
  if (earlier) result.places_solved = local.solved;
  write_speed_layers(update, result.speeds);
  write_sightings(update, sightings);
  if (!request.config.empty()) write_speeds_rules(update, config);
  update.note("speeds", std::to_string(result.visits.size()) + " visits");
  update.commit();
  for (const SpeedCell& cell : result.speeds.cells)
    result.presence_max = std::max(result.presence_max, cell.presence);
  result.digest = load_meta(request.map).digest;
  return result;
}

}  // namespace roadbook
