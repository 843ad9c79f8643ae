#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/output_option.hpp"
#include "apps/vehicle_option.hpp"
#include "apps/verb.hpp"
#include "base/error.hpp"
#include "base/text.hpp"
#include "exchange/export/export_map.hpp"
#include "exchange/export/picture_edge.hpp"
#include "mapping/layers/map_layers.hpp"
#include "mapping/store/map_file.hpp"
#include "semantics/labels/label_classes.hpp"
#include "semantics/labels/label_drives.hpp"
#include "semantics/labels/label_layers.hpp"
#include "semantics/labels/label_store.hpp"

namespace roadbook {
namespace {

struct ExportCommand {
  std::filesystem::path map;
  std::string format;
  std::filesystem::path output;
  std::optional<double> latitude;
  std::optional<double> longitude;
  double x_axis = 0.0;
  std::string from;
  std::string to;
  std::filesystem::path vehicle;
  ExportOptions options;
};

Eigen::Vector3d place_option(const char* option, const std::string& text) {
  const auto fields = split(text);
  const auto x = parse_double(fields[0]);
  const auto y = fields.size() > 1 ? parse_double(fields[1]) : std::nullopt;
  const auto z = fields.size() > 2 ? parse_double(fields[2]) : std::optional<double>(NAN);
  if (!x || !y || !z || fields.size() > 3)
    throw InvalidOption(option, text, "X,Y or X,Y,Z in metres, map frame");
  return {*x, *y, *z};
}

ExportOptions export_options(const ExportCommand& command) {
  ExportOptions options = command.options;
  if (command.latitude.has_value() != command.longitude.has_value())
    throw InvalidOption("--latitude-deg and --longitude-deg", "one of them", "both");
  if (command.from.empty() != command.to.empty())
    throw InvalidOption("--from and --to", "one of them", "both");
  if (!command.from.empty())
    options.route = {place_option("--from", command.from), place_option("--to", command.to)};
  if (command.latitude && command.longitude)
    options.origin = GeoOrigin{*command.latitude, *command.longitude, command.x_axis};
  if (const auto vehicle = given_vehicle(command.vehicle))
    options.vehicle = footprint_of(*vehicle->body());
  return options;
}

void say_rasters_left_out(const ExportCommand& command, const Console& console) {
  std::string names;
  for (const LayerInfo& layer : MapLayers(command.map).list())
    if (layer.raster) names += (names.empty() ? "" : ", ") + layer.name;
  if (!names.empty())
    console.note("rasters are not in it: " + names + "; --format geotiff writes them");
}

// Formats that hold labels, unless other layers were asked for.
bool holds_labels(const ExportCommand& command) {
  for (const char* format : {"coco", "yolo", "lanelet2", "commonroad"})
    if (command.format == format) return true;
  if (command.format != "geojson" && command.format != "gpkg") return false;
  const auto& layers = command.options.layers;
  return layers.empty() || std::any_of(layers.begin(), layers.end(), is_label_layer);
}

// What the map has no place for is in no file; rejections are not in any case.
void warn_of_labels_left_out(const ExportCommand& command, const Console& console) {
  if (!holds_labels(command)) return;
  std::vector<Label> labels = read_labels(command.map);
  std::erase_if(labels, [](const Label& label) { return is_rejected_kind(label.kind); });
  if (labels.empty()) return;
  if (const auto lost = warning_of_lost_places(command.map, load_map(command.map), labels))
    console.warn({*lost});
}

nlohmann::ordered_json say_what_is_left_out(const ExportNotes& notes, const Console& console) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const ExportNote& note : notes) {
    console.note(std::to_string(note.count) + " " + note.what + ": not in the file: " + note.why);
    list.push_back({{"what", note.what}, {"count", note.count}, {"why", note.why}});
  }
  return list;
}

}  // namespace

Verb export_verb() {
  auto command = std::make_shared<ExportCommand>();
  return {"export", "writes a map for other programs",
          [command](Options& options) {
            options.add("--map,-m", &command->map, "map file").required = true;
            Option& format = options.add("--format,-f", &command->format, "format");
            format.required = true;
            format.choices = export_formats();
            options
                .add("--output,-o", &command->output,
                     "file to write; geojson also: folder for a file a layer")
                .required = true;
            options.add("--layer", &command->options.layers,
                        "layer to write; default all, geojson: without landmarks");
            options.add("--step-m", &command->options.step_m, "path: between the rows of a lane")
                .range = {0.001, 1000.0};
            options.add("--from", &command->from,
                        "path: X,Y or X,Y,Z where a route begins [m, map frame]");
            options.add("--to", &command->to, "path: X,Y where it ends");
            options.add("--lane", &command->options.lane, "spm: id of the lane; all");
            options.add("--profile", &command->options.profile, "lanelet2: what the file may hold")
                .choices = lanelet2_profiles();
            options
                .add("--country", &command->options.country,
                     "commonroad: country of the traffic signs; ZAM is none in particular")
                .choices = commonroad_countries();
            options.add("--property", &command->options.property,
                        "spm: friction, or another of the map's properties");
            options
                .add("--resolution-m", &command->options.resolution_m, "nav2: side of a cell [m]")
                .range = {0.01, 5.0};
            options.add("--vehicle", &command->vehicle,
                        "nav2: YAML file with the measures of the vehicle that is to drive; "
                        "default: a car of 4.5 x 1.9 m, or the map's own where larger");
            options.add("--latitude-deg", &command->latitude, "of the map's origin, WGS84");
            options.add("--longitude-deg", &command->longitude, "of the map's origin, WGS84");
            options.add("--x-axis-deg", &command->x_axis,
                        "direction of the map's x axis, counter-clockwise from east");
          },
          [command](Console& console, const CommonOptions&) {
            refuse_to_replace(command->map, command->output);
            warn_of_labels_left_out(*command, console);
            ExportNotes notes;
            const auto files = export_map(command->map, command->format, command->output,
                                          export_options(*command), &notes);
            console.warn(warnings_of_picture_edge(command->map, command->format));
            nlohmann::ordered_json list = nlohmann::ordered_json::array();
            for (const auto& file : files) {
              console.say("wrote " + file.string());
              list.push_back(file.string());
            }
            if (command->format == "gpkg" || command->format == "geojson")
              say_rasters_left_out(*command, console);
            console.result({{"format", command->format},
                            {"files", list},
                            {"left_out", say_what_is_left_out(notes, console)}});
            return ExitStatus::kDone;
          }};
}

}  // namespace roadbook
