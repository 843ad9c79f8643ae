#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>

#include "apps/verb.hpp"
#include "apps/write_file.hpp"
#include "base/format.hpp"
#include "exchange/layers/friction_layers.hpp"
#include "exchange/layers/path_layers.hpp"
#include "exchange/layers/stored_paths.hpp"
#include "mapping/store/map_file.hpp"
#include "speedmap/property_map/slice.hpp"
#include "workflows/friction_update.hpp"
#include "workflows/property_table.hpp"

namespace roadbook {
namespace {

struct FrictionCommand {
  std::filesystem::path drive;
  std::filesystem::path map;
  std::filesystem::path config;
  std::filesystem::path slice;
  std::string lane;
  std::string property = "friction";
  double from_m = 0.0;
  std::optional<double> to_m;
  bool replace = false;
};

int session_number(const Map& map, const Drive& drive, const std::filesystem::path& file) {
  const std::string digest = drive.digest();
  for (std::size_t i = 0; i < map.sessions.size(); ++i)
    if (map.sessions[i].drive_digest == digest) return static_cast<int>(i);
  throw BadInput(Problem{Severity::kError, file.string(), 0, "sessions",
                         "none of drive " + drive.name(),
                         "one (roadbook map DRIVE -m MAP adds it)"});
}

const LaneStrips::Strip& lane_of(const LaneStrips& strips, const std::string& lane) {
  if (lane.empty()) return strips.strips().front();
  for (const LaneStrips::Strip& strip : strips.strips())
    if (std::to_string(strip.lane) == lane) return strip;
  throw InvalidOption("--lane", lane, "the id of a lane with a path");
}

// Throws InvalidOption for options of a slice that is not to be written, or not as a file of its
// kinds.
void check_slice_options(const FrictionCommand& command) {
  const std::string kind = command.slice.extension().string();
  if (!command.slice.empty() && kind != ".json" && kind != ".h" && kind != ".hpp")
    throw InvalidOption("--slice", command.slice.string(), "a file .json, .h or .hpp");
  const bool about_slice = !command.lane.empty() || command.property != "friction" ||
                           command.from_m > 0.0 || command.to_m;
  if (command.slice.empty() && about_slice)
    throw InvalidOption("--slice", "nothing",
                        "a file, where --lane, --property, --from-m or --to-m are given");
}

void write_slice(const FrictionCommand& command, const FrictionMap& friction) {
  const LaneStrips::Strip& strip = lane_of(friction.strips, command.lane);
  const double to_m = command.to_m.value_or(strip.length_m());
  if (!(command.from_m < to_m))
    throw InvalidOption("--from-m", fixed(command.from_m, 3), "less than " + fixed(to_m, 3));
  const PropertySlice slice =
      lane_slice(friction, strip, command.from_m, to_m, command.map.filename().string(),
                 property_of(friction.map, command.property, "--property"));
  const bool header = command.slice.extension() == ".h" || command.slice.extension() == ".hpp";
  write_file(command.slice, header ? slice_header(slice, command.property) : slice_json(slice));
}

// The map to extend, and the rules by which it is extended.
struct Begun {
  FrictionMap friction;
  FrictionConfig config;
};

Begun begin_anew(const std::vector<LanePath>& lanes, const FrictionConfig& config) {
  LaneStrips strips(lanes, config.spacing_m, config.kernel_width_m);
  PropertyMap map(strips.knots(), config.prior(), config.map);
  return {{std::move(strips),
           std::move(map),
           config.spacing_m,
           config.kernel_width_m,
           0,
           {},
           {},
           paths_digest(lanes),
           {},
           config.text()},
          config};
}

// The stored map, or a new one where there is none, where it was made of this drive alone, or where
// that is asked for.
Begun begin(const FrictionCommand& command, const MapLayers& layers, const std::string& session) {
  std::optional<FrictionConfig> given;
  if (!command.config.empty()) given = FrictionConfig::load(command.config);
  require_paths(layers);
  const std::vector<LanePath> lanes = read_path_layers(layers);
  if (command.replace) return begin_anew(lanes, given.value_or(FrictionConfig{}));
  auto stored = read_friction_layers(layers, lanes);
  if (!stored) return begin_anew(lanes, given.value_or(FrictionConfig{}));
  const FrictionConfig rules =
      FrictionConfig::parse(stored->config, command.map.string() + " friction_settings");
  if (stored->sessions == std::vector<std::string>{session})
    return begin_anew(lanes, given.value_or(rules));
  const auto& known = stored->sessions;
  if (std::find(known.begin(), known.end(), session) != known.end())
    throw BadInput(Problem{Severity::kError, command.map.string(), 0, "friction",
                           session + " again", "a drive that is not in it yet, or --replace"});
  if (given) refuse_other_rules(*given, rules, command.config);
  return {std::move(*stored), rules};
}

// Rasters of properties that the map has no more.
void drop_other_rasters(MapUpdate& update, const MapLayers& layers, const PropertyMap& map) {
  if (!layers.has("friction_settings")) return;
  const PlainTable old = layers.read_table("friction_settings");
  for (const auto& row : old.rows) {
    const auto& name = std::get<std::string>(row.front());
    const auto& properties = map.prior().properties;
    if (std::any_of(properties.begin(), properties.end(),
                    [&](const PropertyPrior& property) { return property.name == name; }))
      continue;
    for (const char* what : {"_mean", "_sigma", "_colours"}) (void)update.remove(name + what);
  }
}

nlohmann::ordered_json say_classes(const Console& console, const PropertyMap& map, std::size_t k) {
  nlohmann::ordered_json classes = nlohmann::ordered_json::array();
  const PropertyPrior& about = map.prior().properties[k];
  const std::string unit = about.unit == "-" ? "" : " " + about.unit;
  for (std::size_t i = 0; i < map.classes(); ++i) {
    const NormalGamma& ng = map.property(k)[i];
    const std::string& name = map.prior().classes[i];
    classes.push_back({{"class", name},
                       {"mean", ng.mu},
                       {"sigma_of_mean", std::sqrt(ng.mean_variance())},
                       {"sigma_within", std::sqrt(ng.expected_variance())}});
    console.say(name + ": " + about.name + " " + fixed(ng.mu, 3) + " +- " +
                fixed(std::sqrt(ng.mean_variance()), 3) + unit);
  }
  return classes;
}

nlohmann::ordered_json say_properties(const Console& console,
                                      const PropertyMap& map,
                                      const FrictionSummary& summary) {
  nlohmann::ordered_json properties = nlohmann::ordered_json::array();
  for (std::size_t k = 0; k < map.prior().properties.size(); ++k)
    properties.push_back({{"property", map.prior().properties[k].name},
                          {"unit", map.prior().properties[k].unit},
                          {"values", summary.values[k]},
                          {"classes", say_classes(console, map, k)}});
  return properties;
}

// What was measured and does not count; a property of which there is nothing may be misspelt.
void say_values_left_out(const Console& console,
                         const FrictionCommand& command,
                         const FrictionConfig& config,
                         const FrictionSummary& summary) {
  const auto properties = config.properties();
  for (std::size_t k = 0; k < properties.size(); ++k) {
    if (summary.values[k] > 0) continue;
    const auto file = property_file(command.drive, properties[k]);
    console.note(file.string() + ": " + properties[k].name + ": nothing learned, " +
                 (std::filesystem::exists(file) ? "no value on a lane whose ground has been seen"
                                                : "no such table in the drive"));
  }
  console.say("values left out: " + std::to_string(summary.without_pose) + " without a pose, " +
              std::to_string(summary.off_lanes) + " beside all lanes, " +
              std::to_string(summary.without_labels) + " where too little has been seen");
}

void refuse_nothing(const FrictionCommand& command, const FrictionSummary& summary) {
  const std::string drive = "error: " + command.drive.string();
  if (summary.frames == 0)
    throw Refused(drive + ": segmentation: got no class images, want those of a camera");
  if (std::accumulate(summary.values.begin(), summary.values.end(), std::size_t{0}) == 0)
    throw Refused(
        drive + ": friction0: got no measurement on a lane whose ground has been seen, want some");
}

ExitStatus run_friction(const FrictionCommand& command, Console& console) {
  check_slice_options(command);
  MapUpdate update(command.map);  // nobody changes the map between reading and writing
  const Map map = load_map(command.map);
  const MapLayers layers(command.map);
  const Drive drive = Drive::open(command.drive);
  const int index = session_number(map, drive, command.map);
  const Session& session = map.sessions[static_cast<std::size_t>(index)];
  auto [friction, config] = begin(command, layers, session.name);
  if (!friction.sessions.empty() && session.t_begin_ns > friction.date_ns)
    friction.map.forget(1e-9 * static_cast<double>(session.t_begin_ns - friction.date_ns));
  PropertyMapper mapper(std::move(friction.map), config.refresh);
  const FrictionSummary summary =
      update_friction(drive, map, index, friction.strips, config, mapper, console.progress());
  console.warn(drive.warnings());
  refuse_nothing(command, summary);
  friction.map = mapper.map();
  friction.date_ns = std::max(friction.date_ns, summary.date_ns);
  friction.sessions.push_back(session.name);
  // A slice that cannot be had leaves the map as it was.
  if (!command.slice.empty()) write_slice(command, friction);
  anchor_knots(map, friction);
  drop_other_rasters(update, layers, friction.map);
  write_friction_layers(update, friction);
  update.note("friction", drive.name());
  update.commit();
  if (layers.has("speed_settings"))
    console.note("the speed map was made before this: `roadbook speeds` takes the new grip up");
  say_values_left_out(console, command, config, summary);
  const auto properties = say_properties(console, friction.map, summary);
  console.result({{"frames", summary.frames},
                  {"cells", summary.cells},
                  {"values", summary.values.front()},
                  {"values_without_pose", summary.without_pose},
                  {"values_off_lanes", summary.off_lanes},
                  {"values_without_labels", summary.without_labels},
                  {"refreshes", summary.refreshes},
                  {"sessions", friction.sessions},
                  {"knots_dropped", friction.carry.dropped},
                  {"lanes", friction.strips.strips().size()},
                  {"knots", friction.map.knots().size()},
                  {"classes", properties.front().at("classes")},
                  {"properties", properties}});
  return ExitStatus::kDone;
}

}  // namespace

Verb friction_verb() {
  auto command = std::make_shared<FrictionCommand>();
  return {
      "friction", "learns the ground's friction along the lanes of a map",
      [command](Options& options) {
        options.add("DRIVE", &command->drive, "a drive of the map, with class images and friction")
            .required = true;
        options.add("--map,-m", &command->map, "map file, after `roads`").required = true;
        options.add("--config", &command->config,
                    "YAML file: classes, priors, further properties, models");
        options.add("--replace", &command->replace,
                    "begins anew instead of adding to what is there");
        options.add("--slice", &command->slice, "file for a controller: .json or .h");
        options.add("--property", &command->property, "of the slice: friction, or another one");
        options.add("--lane", &command->lane, "lane of the slice; the first");
        options.add("--from-m", &command->from_m, "where the slice begins [m]").range = {0.0, 1e6};
        options.add("--to-m", &command->to_m, "where it ends [m]; the lane's end");
      },
      [command](Console& console, const CommonOptions&) {
        return run_friction(*command, console);
      }};
}

}  // namespace roadbook
