#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/format.hpp"
#include "apps/friction_update.hpp"
#include "apps/verb.hpp"
#include "apps/write_file.hpp"
#include "exchange/path_layers.hpp"
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
};

int session_of(const Map& map, const Drive& drive, const std::filesystem::path& file) {
  const std::string digest = drive.digest();
  for (std::size_t i = 0; i < map.sessions.size(); ++i)
    if (map.sessions[i].drive_digest == digest) return static_cast<int>(i);
  throw BadInput(Problem{Severity::kError, file.string(), 0, "sessions",
                         "none of drive " + drive.name(),
                         "one (roadbook map DRIVE -m MAP adds it)"});
}

// Every knot with what is known there: points for GIS programs.
VectorLayer friction_layer(const PropertyMap& map, const LaneStrips& strips, std::int64_t date_ns) {
  VectorLayer layer;
  layer.name = "friction";
  layer.description = "friction of the ground: mean, standard deviation, labels seen";
  layer.type = GeometryType::kPointZ;
  layer.fields = {{"lane", FieldType::kText},        {"s_m", FieldType::kReal},
                  {"e_m", FieldType::kReal},         {"mean", FieldType::kReal},
                  {"sigma", FieldType::kReal},       {"class", FieldType::kText},
                  {"class_share", FieldType::kReal}, {"evidence", FieldType::kReal},
                  {"newest_utc", FieldType::kText}};
  std::vector<double> shares(map.classes());
  for (std::size_t l = 0; l < map.knots().size(); ++l) {
    const PathPlace place = map.knots().places()[l];
    const LaneStrips::Strip& strip = strips.strip_of(place);
    const auto p = strip.frame.position(place.s_m - strip.begin_m, place.e_m);
    if (!p) continue;
    const PropertyMoments moments = map.knot_moments(0, l);
    map.knot_shares(l, shares);
    const auto best =
        static_cast<std::size_t>(std::max_element(shares.begin(), shares.end()) - shares.begin());
    layer.features.push_back({{{p->x(), p->y(), 0.0, 0.0}},
                              {std::to_string(strip.lane), place.s_m - strip.begin_m, place.e_m,
                               moments.mean, std::sqrt(moments.variance), map.prior().classes[best],
                               shares[best], map.knot_evidence(l), utc_text(date_ns)}});
  }
  return layer;
}

PlainTable class_table(const PropertyMap& map) {
  PlainTable table;
  table.name = "property_classes";
  table.fields = {{"property", FieldType::kText}, {"class", FieldType::kText},
                  {"mu", FieldType::kReal},       {"lambda", FieldType::kReal},
                  {"alpha", FieldType::kReal},    {"beta", FieldType::kReal}};
  for (std::size_t property = 0; property < map.prior().properties.size(); ++property)
    for (std::size_t i = 0; i < map.classes(); ++i) {
      const NormalGamma& ng = map.property(property)[i];
      table.rows.push_back({map.prior().properties[property].name, map.prior().classes[i], ng.mu,
                            ng.lambda, ng.alpha, ng.beta});
    }
  return table;
}

const LaneStrips::Strip& lane_of(const LaneStrips& strips, const std::string& lane) {
  if (lane.empty()) return strips.strips().front();
  for (const LaneStrips::Strip& strip : strips.strips())
    if (std::to_string(strip.lane) == lane) return strip;
  throw InvalidOption("--lane", lane, "the id of a lane with a path");
}

void write_slice(const FrictionCommand& command,
                 const PropertyMap& map,
                 const LaneStrips& strips,
                 std::int64_t date_ns) {
  const LaneStrips::Strip& strip = lane_of(strips, command.lane);
  const double to = command.to_m.value_or(strip.frame.curve().length_m());
  PropertySlice slice = make_slice(
      map, 0, strip.begin_m + command.from_m, strip.begin_m + to,
      {command.map.filename().string() + " lane " + std::to_string(strip.lane), date_ns});
  // The lane's own s.
  slice.s_begin_m -= strip.begin_m;
  slice.s_end_m -= strip.begin_m;
  for (SliceKnot& knot : slice.knots) knot.s_m -= strip.begin_m;
  const bool header = command.slice.extension() == ".h" || command.slice.extension() == ".hpp";
  write_file(command.slice, header ? slice_header(slice, "friction") : slice_json(slice));
}

ExitStatus run(const FrictionCommand& command, Console& console) {
  const FrictionConfig config =
      command.config.empty() ? FrictionConfig{} : FrictionConfig::load(command.config);
  const Map map = load_map(command.map);
  const LaneStrips strips(read_path_layers(MapLayers(command.map)), config.spacing_m,
                          config.kernel_width_m);
  const Drive drive = Drive::open(command.drive);
  const int session = session_of(map, drive, command.map);
  PropertyMapper mapper(PropertyMap(strips.knots(), config.prior(), config.map), config.refresh);
  const FrictionSummary summary =
      update_friction(drive, map, session, strips, config, mapper, console.progress());
  console.warn(drive.warnings());
  if (summary.frames == 0)
    throw Refused("error: " + command.drive.string() +
                  ": segmentation: got no class images, want those of a camera");
  if (summary.values == 0)
    throw Refused(
        "error: " + command.drive.string() +
        ": friction0: got no measurement on a lane whose ground has been seen, want some");
  MapUpdate update(command.map);
  update.write_layer(friction_layer(mapper.map(), strips, summary.date_ns));
  update.write_table(class_table(mapper.map()));
  update.note("friction", drive.name());
  update.commit();
  if (!command.slice.empty()) write_slice(command, mapper.map(), strips, summary.date_ns);

  nlohmann::ordered_json classes = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < config.classes.size(); ++i) {
    const NormalGamma& ng = mapper.map().property(0)[i];
    classes.push_back({{"class", config.classes[i]},
                       {"mean", ng.mu},
                       {"sigma_of_mean", std::sqrt(ng.mean_variance())},
                       {"sigma_within", std::sqrt(ng.expected_variance())}});
    console.say(config.classes[i] + ": friction " + fixed(ng.mu, 3) + " +- " +
                fixed(std::sqrt(ng.mean_variance()), 3));
  }
  console.result({{"frames", summary.frames},
                  {"cells", summary.cells},
                  {"values", summary.values},
                  {"values_without_pose", summary.without_pose},
                  {"values_off_lanes", summary.off_lanes},
                  {"values_without_labels", summary.without_labels},
                  {"refreshes", summary.refreshes},
                  {"lanes", strips.strips().size()},
                  {"knots", strips.knots().size()},
                  {"classes", classes}});
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
        options.add("--slice", &command->slice, "file for a controller: .json or .h");
        options.add("--lane", &command->lane, "lane of the slice; the first");
        options.add("--from-m", &command->from_m, "where the slice begins [m]").range = {0.0, 1e6};
        options.add("--to-m", &command->to_m, "where it ends [m]; the lane's end");
      },
      [command](Console& console, const CommonOptions&) { return run(*command, console); }};
}

}  // namespace roadbook
