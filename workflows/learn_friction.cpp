#include "workflows/learn_friction.hpp"

#include <algorithm>
#include <numeric>

#include "base/format.hpp"
#include "base/whole_file.hpp"
#include "exchange/layers/friction_layers.hpp"
#include "exchange/layers/layer_ages.hpp"
#include "exchange/layers/path_layers.hpp"
#include "exchange/layers/stored_paths.hpp"
#include "mapping/pieces.hpp"
#include "mapping/store/map_file.hpp"
#include "speedmap/property_map/slice.hpp"
#include "workflows/property_table.hpp"

namespace roadbook {
namespace {

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

// Throws InvalidOption for options of a slice if no slice is requested, or if the file's kind does
// not fit.
void check_slice_options(const FrictionRequest& request) {
  const std::string kind = request.slice.extension().string();
  if (!request.slice.empty() && kind != ".json" && kind != ".h" && kind != ".hpp")
    throw InvalidOption("--slice", request.slice.string(), "a file .json, .h or .hpp");
  const bool about_slice = !request.lane.empty() || request.property != "friction" ||
                           request.from_m > 0.0 || request.to_m;
  if (request.slice.empty() && about_slice)
    throw InvalidOption("--slice", "nothing",
                        "a file, where --lane, --property, --from-m or --to-m are given");
}

void write_slice(const FrictionRequest& request, const FrictionMap& friction) {
  const LaneStrips::Strip& strip = lane_of(friction.strips, request.lane);
  const double to_m = request.to_m.value_or(strip.length_m());
  if (!(request.from_m < to_m))
    throw InvalidOption("--from-m", fixed(request.from_m, 3), "less than " + fixed(to_m, 3));
  const PropertySlice slice =
      lane_slice(friction, strip, request.from_m, to_m, request.map.filename().string(),
                 property_of(friction.map, request.property, "--property"));
  const bool header = request.slice.extension() == ".h" || request.slice.extension() == ".hpp";
  write_whole_file(request.slice,
                   header ? slice_header(slice, request.property) : slice_json(slice));
}

// The map to extend, and the settings for extending it.
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

// Returns the stored map. Returns a new map if no map is stored, if the stored map comes from this
// drive alone, or if the user requests a new one.
Begun begin(const FrictionRequest& request, const MapLayers& layers, const std::string& session) {
  std::optional<FrictionConfig> given;
  if (!request.config.empty()) given = FrictionConfig::load(request.config);
  require_paths(layers);
  const std::vector<LanePath> lanes = read_path_layers(layers);
  if (request.replace) return begin_anew(lanes, given.value_or(FrictionConfig{}));
  auto stored = read_friction_layers(layers, lanes);
  if (!stored) return begin_anew(lanes, given.value_or(FrictionConfig{}));
  const FrictionConfig rules =
      FrictionConfig::parse(stored->config, request.map.string() + " friction_settings");
  if (stored->sessions == std::vector<std::string>{session})
    return begin_anew(lanes, given.value_or(rules));
  const auto& known = stored->sessions;
  if (std::find(known.begin(), known.end(), session) != known.end())
    throw BadInput(Problem{Severity::kError, request.map.string(), 0, "friction",
                           session + " again", "a drive that is not in it yet, or --replace"});
  if (given) refuse_other_rules(*given, rules, request.config);
  return {std::move(*stored), rules};
}

// Removes rasters of properties that the map no longer has.
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

void refuse_nothing(const FrictionRequest& request, const FrictionSummary& summary) {
  const std::string drive = "error: " + request.drive.string();
  if (summary.frames == 0)
    throw Refused(drive + ": segmentation: got no class images, want those of a camera");
  if (std::accumulate(summary.values.begin(), summary.values.end(), std::size_t{0}) == 0)
    throw Refused(
        drive + ": friction0: got no measurement on a lane whose ground has been seen, want some");
}

}  // namespace

FrictionResult learn_friction(const FrictionRequest& request, Messages& messages) {
  check_slice_options(request);
  MapUpdate update(request.map);  // locks the map between reading and writing
  const Map map = load_joined_map(request.map);
  const MapLayers layers(request.map);
  const Drive drive = Drive::open(request.drive);
  const int index = session_number(map, drive, request.map);
  const Session& session = map.sessions[static_cast<std::size_t>(index)];
  auto [friction, config] = begin(request, layers, session.name);
  if (!friction.sessions.empty() && session.t_begin_ns > friction.date_ns)
    friction.map.forget(1e-9 * static_cast<double>(session.t_begin_ns - friction.date_ns));
  PropertyMapper mapper(std::move(friction.map), config.refresh);
  const FrictionSummary summary =
      update_friction(drive, map, index, friction.strips, config, mapper, messages.progress());
  messages.warn(drive.warnings());
  refuse_nothing(request, summary);
  friction.map = mapper.map();
  friction.date_ns = std::max(friction.date_ns, summary.date_ns);
  friction.sessions.push_back(session.name);
  // If the slice cannot be written, the map stays unchanged.
  if (!request.slice.empty()) write_slice(request, friction);
  anchor_knots(map, friction);
  drop_other_rasters(update, layers, friction.map);
  write_friction_layers(update, friction);
  write_raster_age(update, layers, {"friction_mean", friction.date_ns, kFrictionHalfLife_s},
                   friction.date_ns);
  update.note("friction", drive.name());
  update.commit();
  return {std::move(friction), std::move(config), summary, layers.has("speed_settings")};
}

}  // namespace roadbook
