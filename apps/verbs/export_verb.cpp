#include <cmath>
#include <memory>

#include "apps/output_option.hpp"
#include "apps/summaries/export_summary.hpp"
#include "apps/vehicle_option.hpp"
#include "apps/verb.hpp"
#include "base/error.hpp"
#include "base/text.hpp"

namespace roadbook {
namespace {

struct ExportCommand {
  ExportRequest request;
  std::optional<double> latitude;
  std::optional<double> longitude;
  double x_axis = 0.0;
  std::string from;
  std::string to;
  std::filesystem::path vehicle;
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

ExportRequest request_of(const ExportCommand& command) {
  ExportRequest request = command.request;
  if (command.latitude.has_value() != command.longitude.has_value())
    throw InvalidOption("--latitude-deg and --longitude-deg", "one of them", "both");
  if (command.from.empty() != command.to.empty())
    throw InvalidOption("--from and --to", "one of them", "both");
  if (!command.from.empty())
    request.options.route = {place_option("--from", command.from),
                             place_option("--to", command.to)};
  if (command.latitude && command.longitude)
    request.options.origin = GeoOrigin{*command.latitude, *command.longitude, command.x_axis};
  if (const auto vehicle = given_vehicle(command.vehicle))
    request.options.vehicle = footprint_of(*vehicle->body());
  return request;
}

void add_export_options(Options& options, ExportCommand& command) {
  options.add("--map,-m", &command.request.map, "map file").required = true;
  Option& format = options.add("--format,-f", &command.request.format, "format");
  format.required = true;
  format.choices = export_formats();
  options
      .add("--output,-o", &command.request.output,
           "file to write; geojson: a file, or a folder for one file per layer")
      .required = true;
  options.add("--layer", &command.request.options.layers,
              "layer to write; may be repeated; default: all (geojson: all but landmarks)");
  options.add("--step-m", &command.request.options.step_m, "path: distance between rows [m]")
      .range = {0.001, 1000.0};
  options.add("--from", &command.from, "path: begin of a route, X,Y or X,Y,Z [m, map frame]");
  options.add("--to", &command.to, "path: end of the route, X,Y");
  options.add("--lane", &command.request.options.lane, "spm: id of the lane; default: all");
  options
      .add("--profile", &command.request.options.profile,
           "lanelet2: extensions that the file may hold")
      .choices = lanelet2_profiles();
  options
      .add("--country", &command.request.options.country,
           "commonroad: country of the traffic signs; ZAM is no real country")
      .choices = commonroad_countries();
  options.add("--property", &command.request.options.property, "spm: property of the map");
  options.add("--resolution-m", &command.request.options.resolution_m, "nav2: side of a cell [m]")
      .range = {0.01, 5.0};
  options.add("--vehicle", &command.vehicle,
              "nav2: YAML file with the measures of the vehicle that will drive; "
              "default: a car of 4.5 x 1.9 m, or the recording vehicle if larger");
  options.add("--latitude-deg", &command.latitude, "place of the map's origin, WGS84");
  options.add("--longitude-deg", &command.longitude, "place of the map's origin, WGS84");
  options.add("--x-axis-deg", &command.x_axis,
              "direction of the map's x axis, counter-clockwise from east");
}

}  // namespace

Verb export_verb() {
  auto command = std::make_shared<ExportCommand>();
  return {"export", "writes a map for other programs",
          [command](Options& options) { add_export_options(options, *command); },
          [command](Console& console, const CommonOptions&) {
            refuse_to_replace(command->request.map, command->request.output);
            console.warn(labels_without_place(command->request));
            print_export(console, export_place(request_of(*command)), command->request.format);
            return ExitStatus::kDone;
          }};
}

}  // namespace roadbook
