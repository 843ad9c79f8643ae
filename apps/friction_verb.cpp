#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/format.hpp"
#include "apps/friction_update.hpp"
#include "apps/verb.hpp"
#include "apps/write_file.hpp"
#include "exchange/friction_layers.hpp"
#include "exchange/path_layers.hpp"
#include "exchange/stored_paths.hpp"
#include "mapping/map_file.hpp"
#include "speedmap/slice.hpp"

namespace roadbook {
namespace {

struct FrictionCommand {
  std::filesystem::path drive;
  std::filesystem::path map;
  std::filesystem::path config;
  std::filesystem::path slice;
  std::string lane;
  double from_m = 0.0;
  std::optional<double> to_m;
  bool replace = false;
};

int session_of(const Map& map, const Drive& drive, const std::filesystem::path& file) {
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

void write_slice(const FrictionCommand& command, const FrictionMap& friction) {
  const LaneStrips::Strip& strip = lane_of(friction.strips, command.lane);
  const PropertySlice slice =
      lane_slice(friction, strip, command.from_m, command.to_m.value_or(strip.length_m()),
                 command.map.filename().string());
  const bool header = command.slice.extension() == ".h" || command.slice.extension() == ".hpp";
  write_file(command.slice, header ? slice_header(slice, "friction") : slice_json(slice));
}

FrictionMap new_friction_map(const std::vector<LanePath>& lanes, const FrictionConfig& config) {
  LaneStrips strips(lanes, config.spacing_m, config.kernel_width_m);
  PropertyMap map(strips.knots(), config.prior(), config.map);
  return {std::move(strips), std::move(map), config.spacing_m, config.kernel_width_m, 0, {}, 0};
}

// The map to extend: the stored one, or a new one where there is none, where it was made of this
// drive alone, or where that is asked for.
FrictionMap friction_map_of(const FrictionCommand& command,
                            const FrictionConfig& config,
                            const std::string& session) {
  const MapLayers layers(command.map);
  require_paths(layers);
  const std::vector<LanePath> lanes = read_path_layers(layers);
  if (command.replace) return new_friction_map(lanes, config);
  auto stored = read_friction_layers(layers, lanes);
  if (!stored || stored->sessions == std::vector<std::string>{session})
    return new_friction_map(lanes, config);
  const auto refuse = [&](const char* field, const std::string& got, const std::string& want) {
    throw BadInput(Problem{Severity::kError, command.map.string(), 0, field, got, want});
  };
  const auto& known = stored->sessions;
  if (std::find(known.begin(), known.end(), session) != known.end())
    refuse("friction", session + " again", "a drive that is not in it yet, or --replace");
  if (stored->map.prior().classes != config.classes)
    refuse("friction", "other classes", "those of the configuration, or --replace");
  return std::move(*stored);
}

nlohmann::ordered_json say_classes(const Console& console, const PropertyMap& map) {
  nlohmann::ordered_json classes = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < map.classes(); ++i) {
    const NormalGamma& ng = map.property(0)[i];
    const std::string& name = map.prior().classes[i];
    classes.push_back({{"class", name},
                       {"mean", ng.mu},
                       {"sigma_of_mean", std::sqrt(ng.mean_variance())},
                       {"sigma_within", std::sqrt(ng.expected_variance())}});
    console.say(name + ": friction " + fixed(ng.mu, 3) + " +- " +
                fixed(std::sqrt(ng.mean_variance()), 3));
  }
  return classes;
}

ExitStatus run(const FrictionCommand& command, Console& console) {
  const FrictionConfig config =
      command.config.empty() ? FrictionConfig{} : FrictionConfig::load(command.config);
  MapUpdate update(command.map);  // nobody changes the map between reading and writing
  const Map map = load_map(command.map);
  const Drive drive = Drive::open(command.drive);
  const int session = session_of(map, drive, command.map);
  const std::string& name = map.sessions[static_cast<std::size_t>(session)].name;
  FrictionMap friction = friction_map_of(command, config, name);
  const std::size_t before = friction.sessions.size();
  const std::int64_t begin_ns = map.sessions[static_cast<std::size_t>(session)].t_begin_ns;
  if (before > 0 && begin_ns > friction.date_ns)
    friction.map.forget(1e-9 * static_cast<double>(begin_ns - friction.date_ns));
  PropertyMapper mapper(std::move(friction.map), config.refresh);
  const FrictionSummary summary =
      update_friction(drive, map, session, friction.strips, config, mapper, console.progress());
  console.warn(drive.warnings());
  if (summary.frames == 0)
    throw Refused("error: " + command.drive.string() +
                  ": segmentation: got no class images, want those of a camera");
  if (summary.values == 0)
    throw Refused(
        "error: " + command.drive.string() +
        ": friction0: got no measurement on a lane whose ground has been seen, want some");
  friction.map = mapper.map();
  friction.date_ns = std::max(friction.date_ns, summary.date_ns);
  friction.sessions.push_back(name);
  // A slice that cannot be had leaves the map as it was.
  if (!command.slice.empty()) write_slice(command, friction);
  write_friction_layers(update, friction);
  update.note("friction", drive.name());
  update.commit();
  console.result({{"frames", summary.frames},
                  {"cells", summary.cells},
                  {"values", summary.values},
                  {"values_without_pose", summary.without_pose},
                  {"values_off_lanes", summary.off_lanes},
                  {"values_without_labels", summary.without_labels},
                  {"refreshes", summary.refreshes},
                  {"sessions", friction.sessions},
                  {"knots_dropped", friction.dropped},
                  {"lanes", friction.strips.strips().size()},
                  {"knots", friction.map.knots().size()},
                  {"classes", say_classes(console, friction.map)}});
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
        options.add("--config", &command->config, "YAML file: classes and prior");
        options.add("--replace", &command->replace,
                    "begins anew instead of adding to what is there");
        options.add("--slice", &command->slice, "file for a controller: .json or .h");
        options.add("--lane", &command->lane, "lane of the slice; the first");
        options.add("--from-m", &command->from_m, "where the slice begins [m]").range = {0.0, 1e6};
        options.add("--to-m", &command->to_m, "where it ends [m]; the lane's end");
      },
      [command](Console& console, const CommonOptions&) { return run(*command, console); }};
}

}  // namespace roadbook
