#include <algorithm>
#include <memory>

#include "apps/summaries/import_summary.hpp"
#include "apps/user_name.hpp"
#include "apps/verb.hpp"

namespace roadbook {
namespace {

struct ImportCommand {
  std::string format;
  std::filesystem::path source;
  std::filesystem::path output;
  ImportOptions options;
  std::filesystem::path map;
  std::string who;
  std::string class_field;
  std::optional<double> latitude;
  std::optional<double> longitude;
  double x_axis = 0.0;
};

bool is_of_labels(const std::string& format) {
  const auto& formats = label_import_formats();
  return std::find(formats.begin(), formats.end(), format) != formats.end();
}

ExitStatus run_labels(const ImportCommand& command, Console& console) {
  if (command.map.empty())
    throw InvalidOption("--map", "nothing", "the map that the labels are for");
  if (command.latitude.has_value() != command.longitude.has_value())
    throw InvalidOption("--latitude-deg and --longitude-deg", "one of them", "both");
  std::optional<GeoOrigin> origin;
  if (command.latitude) origin = GeoOrigin{*command.latitude, *command.longitude, command.x_axis};
  const LabelImport made = import_labels(command.map, command.format, command.source,
                                         user_name(command.who), origin, command.class_field);
  print_imported_labels(console, made, command.map);
  return ExitStatus::kDone;
}

ExitStatus run_import(const ImportCommand& command, Console& console) {
  if (is_of_labels(command.format)) return run_labels(command, console);
  if (command.output.empty())
    throw InvalidOption("--output", "nothing", "the folder of the drive to write");
  const ImportResult made = import_drive(command.format, command.source, command.output,
                                         command.options, console.progress());
  console.warn(made.warnings);
  const DriveReport report = check_drive(command.output);
  print_imported_drive(console, made, report, command.output);
  return report.usable ? ExitStatus::kDone : ExitStatus::kBadInput;
}

}  // namespace

Verb import_verb() {
  auto command = std::make_shared<ImportCommand>();
  return {
      "import", "converts a recording into a drive, or reads labels into a map",
      [command](Options& options) {
        Option& format =
            options.add("FORMAT", &command->format, "format of the recording or of the labels");
        format.required = true;
        format.choices = import_formats();
        format.choices.insert(format.choices.end(), label_import_formats().begin(),
                              label_import_formats().end());
        options.add("SOURCE", &command->source, "recording, or labels").required = true;
        options.add("--output,-o", &command->output, "folder of the drive to write");
        options.add("--map,-m", &command->map, "labels: map that receives them");
        options.add("--who", &command->who,
                    "labels: name of the user; default: of the system's user");
        options.add("--latitude-deg", &command->latitude,
                    "geojson: place of the map's origin, WGS84; default: as the map knows it");
        options.add("--longitude-deg", &command->longitude, "geojson: place of the map's origin");
        options.add("--x-axis-deg", &command->x_axis,
                    "geojson: direction of the map's x axis, counter-clockwise from east");
        options.add("--class-field", &command->class_field,
                    "geojson: property that holds the class; default: class");
        ImportOptions& how = command->options;
        options
            .add("--camera-height-m", &how.camera_height_m, "kitti: height of the first camera [m]")
            .range = {0.1, 10.0};
        options
            .add("--camera-forward-m", &how.camera_forward_m,
                 "kitti: first camera ahead of the rear axle [m]")
            .range = {-10.0, 10.0};
        options
            .add("--max-left-out", &how.max_left_out,
                 "largest share of a file's rows that may be left out")
            .range = {0.0, 1.0};
        options.add("--overwrite", &how.overwrite, "replace an existing drive");
      },
      [command](Console& console, const CommonOptions&) { return run_import(*command, console); }};
}

}  // namespace roadbook
