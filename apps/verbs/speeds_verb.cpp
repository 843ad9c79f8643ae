#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/session_drives.hpp"
#include "apps/verb.hpp"
#include "base/format.hpp"
#include "exchange/layers/network_layers.hpp"
#include "exchange/layers/path_layers.hpp"
#include "exchange/layers/stored_paths.hpp"
#include "mapping/session_car.hpp"
#include "mapping/store/map_file.hpp"
#include "semantics/labels/label_layers.hpp"
#include "semantics/labels/label_store.hpp"
#include "workflows/merge_sightings.hpp"
#include "workflows/speeds_rules.hpp"
#include "workflows/speeds_update.hpp"
#include "workflows/truth_scene.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

struct SpeedsCommand {
  std::filesystem::path map;
  std::vector<std::filesystem::path> detections;
  std::vector<std::string> observed;
  bool replace = false;
  bool truth = false;
  bool local = false;
  double days_later = 0.0;
  std::filesystem::path config;
};

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

// A layer of places, where the map has none of that name.
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

// What was taken from tables and truth, and what could not be.
struct Taken {
  MergeCount tables;
  MergeCount truth;
  std::vector<std::string> empty_tables;
  std::size_t without_session = 0;
};

void add(MergeCount& sum, const MergeCount& one) {
  sum.added += one.added;
  sum.known += one.known;
  sum.replaced += one.replaced;
}

void take_tables(const SpeedsCommand& command,
                 const Map& map,
                 SpeedSources& sources,
                 Taken& taken) {
  std::vector<Detection> detections;
  for (const auto& file : command.detections) {
    const auto rows = read_detections(file);
    if (rows.empty()) taken.empty_tables.push_back(file.string());
    detections.insert(detections.end(), rows.begin(), rows.end());
  }
  taken.tables = merge_sightings(
      sources.sightings, by_session(map, detections, command.observed, taken.without_session), map,
      command.replace);
}

// The truth knows all there was: it takes the place of whatever was said of its sessions before.
void take_truth(const Map& map,
                const std::filesystem::path& file,
                double range_m,
                SpeedSources& sources,
                Taken& taken) {
  for (std::size_t i = 0; i < map.sessions.size(); ++i) {
    TruthScene scene =
        read_truth_scene(map, static_cast<int>(i), session_folder(file, map.sessions[i]), range_m);
    add(taken.truth, merge_sightings(sources.sightings, {std::move(scene.sightings)}, map, true));
    if (sources.spaces.empty()) sources.spaces = std::move(scene.spaces);
    if (sources.crossings.empty()) sources.crossings = std::move(scene.crossings);
  }
}

ordered_json lanes_json(const SpeedMap& speeds) {
  ordered_json lanes = ordered_json::array();
  for (const LaneProfile& profile : speeds.profiles) {
    double slowest = INFINITY;
    double time = 0.0;
    for (const LaneSpeed& place : profile.places) {
      slowest = std::min(slowest, place.speed);
      time += profile.step_m / place.speed;
    }
    const double length =
        profile.step_m * static_cast<double>(profile.places.size() - (profile.closed ? 0 : 1));
    lanes.push_back({{"lane", std::to_string(profile.lane)},
                     {"length_m", length},
                     {"seconds", time},
                     {"slowest_mps", slowest}});
  }
  return lanes;
}

ordered_json visits_json(const std::vector<VisitSummary>& visits) {
  ordered_json list = ordered_json::array();
  for (const VisitSummary& visit : visits)
    list.push_back({{"session", visit.session},
                    {"frames", visit.frames},
                    {"people", visit.people},
                    {"people_off_map", visit.off_map},
                    {"people_without_pose", visit.without_pose},
                    {"weight", visit.weight}});
  return list;
}

SpeedSources sources_of(const SpeedsCommand& command,
                        const Map& map,
                        const SpeedsConfig& config,
                        Taken& taken) {
  const MapLayers layers(command.map);
  require_paths(layers);
  SpeedSources sources;
  sources.network = read_network_layers(layers);
  sources.paths = read_path_layers(layers);
  const auto labels = label_layers_of_today(layers);
  sources.spaces = outlines_of(layers, labels, "parking_spaces");
  sources.crossings = outlines_of(layers, labels, "crossings");
  sources.friction = read_friction_layers(layers, sources.paths);
  sources.sightings = stored_sightings(layers, map);
  take_tables(command, map, sources, taken);
  if (command.truth) take_truth(map, command.map, config.sight.range_m, sources, taken);
  return sources;
}

std::string counted(std::size_t n, const char* of) { return std::to_string(n) + " " + of; }

// Whatever was given and does not count, one line each.
void say_people_left_out(const Console& console,
                         const Taken& taken,
                         const std::vector<VisitSummary>& visits) {
  for (const std::string& file : taken.empty_tables)
    console.note(file + ": no rows; a session in which nobody was found is named with --observed");
  if (taken.without_session > 0)
    console.note(counted(taken.without_session,
                         "detections lie outside the time of every session and are left out"));
  if (taken.tables.known > 0)
    console.note(counted(taken.tables.known, "detections are in the map already: counted once"));
  if (taken.tables.replaced > 0)
    console.note(counted(taken.tables.replaced, "older detections replaced"));
  if (taken.truth.replaced > 0)
    console.note(counted(taken.truth.replaced, "older detections replaced by the truth"));
  for (const VisitSummary& visit : visits) {
    if (visit.off_map > 0)
      console.note(visit.session + ": " +
                   counted(visit.off_map,
                           "people where the map has no place (off lanes and what "
                           "lies beside them) are left out"));
    if (visit.without_pose > 0)
      console.note(
          visit.session + ": " +
          counted(visit.without_pose, "people at times when the map has no pose are left out"));
  }
}

void say_speeds(const Console& console, const SpeedMap& speeds, std::size_t visits, double most) {
  console.say(std::to_string(speeds.cells.size()) + " places, " +
              fixed(100.0 * speeds.coverage(), 1) + " % of them seen in " + std::to_string(visits) +
              " visits; presence at most " + fixed(most, 3));
  for (const LaneProfile& profile : speeds.profiles) {
    const auto slowest =
        std::min_element(profile.places.begin(), profile.places.end(),
                         [](const LaneSpeed& a, const LaneSpeed& b) { return a.speed < b.speed; });
    console.say("lane " + std::to_string(profile.lane) + ": slowest " + fixed(slowest->speed, 2) +
                " m/s at " + fixed(slowest->s_m, 1) + " m");
  }
}

ExitStatus run_speeds(const SpeedsCommand& command, Console& console) {
  MapUpdate update(command.map);  // nobody changes the map between reading and writing
  const Map map = load_map(command.map);
  const auto [config, kept] =
      speeds_rules(MapLayers(command.map), command.config, vehicle_width_m(map));
  Taken taken;
  SpeedSources sources = sources_of(command, map, config, taken);
  write_label_layers(update, MapLayers(command.map), map, read_labels(command.map));
  const auto gone = limits_without_lane(config, sources.network, command.config, command.map);
  // Places that the truth has told stay in the map, for the next time without it.
  if (command.truth) {
    keep_outlines(update, command.map, "parking_spaces", sources.spaces);
    keep_outlines(update, command.map, "crossings", sources.crossings);
  }
  std::int64_t now_ns = 0;
  for (const Session& session : map.sessions) now_ns = std::max(now_ns, session.t_end_ns);
  now_ns += static_cast<std::int64_t>(command.days_later * 86400.0) * 1'000'000'000;
  const std::vector<SessionSightings> sightings = sources.sightings;
  std::vector<VisitSummary> visits;
  const auto earlier = command.local ? read_speed_layers(MapLayers(command.map)) : std::nullopt;
  LocalUpdate local{earlier ? &*earlier : nullptr, 0};
  const SpeedMap speeds =
      make_speed_map(map, std::move(sources), config, now_ns, visits, earlier ? &local : nullptr);
  write_speed_layers(update, speeds);
  write_sightings(update, sightings);
  if (!command.config.empty()) write_speeds_rules(update, config);
  update.note("speeds", std::to_string(visits.size()) + " visits");
  update.commit();

  if (kept) console.say("by the configuration that the map keeps; --config replaces it");
  for (const std::uint64_t lane : gone)
    console.note("limits_mps: lane " + std::to_string(lane) +
                 " is no more; its limit holds nowhere (--config tells limits anew)");
  say_people_left_out(console, taken, visits);
  double most = 0.0;
  for (const SpeedCell& cell : speeds.cells) most = std::max(most, cell.presence);
  say_speeds(console, speeds, visits.size(), most);
  if (earlier)
    console.say("solved for " + std::to_string(local.solved) + " places around what is new");
  console.result({{"places", speeds.cells.size()},
                  {"places_solved", earlier ? local.solved : speeds.cells.size()},
                  {"coverage", speeds.coverage()},
                  {"presence_max", most},
                  {"detections_added", taken.tables.added + taken.truth.added},
                  {"detections_known", taken.tables.known + taken.truth.known},
                  {"detections_replaced", taken.tables.replaced + taken.truth.replaced},
                  {"detections_without_session", taken.without_session},
                  {"tables_without_rows", taken.empty_tables},
                  {"visits", visits_json(visits)},
                  {"lanes", lanes_json(speeds)},
                  {"config_kept", kept},
                  {"digest", load_meta(command.map).digest}});
  return ExitStatus::kDone;
}

}  // namespace

Verb speeds_verb() {
  auto command = std::make_shared<SpeedsCommand>();
  return {
      "speeds", "where people are met, and how fast to drive",
      [command](Options& options) {
        options.add("--map,-m", &command->map, "map file, after `roads`").required = true;
        options.add("--detections", &command->detections,
                    "tables of people seen, in the frame of the vehicle");
        options.add("--observed", &command->observed,
                    "session in which people were looked for, though nobody may be in a table");
        options.add("--replace", &command->replace,
                    "sessions in the tables lose the detections they had before");
        options.add("--local", &command->local,
                    "begins from the map's speeds: solves around new rows alone, to 1e-6");
        options.add("--truth", &command->truth,
                    "people, spaces and crossings from the truth of simulated drives");
        options
            .add("--days-later", &command->days_later,
                 "the map as it will be then, if nobody drives there before")
            .range = {0.0, 36500.0};
        options.add("--config", &command->config, "YAML file: priors, speeds, limits");
      },
      [command](Console& console, const CommonOptions&) { return run_speeds(*command, console); }};
}

}  // namespace roadbook
