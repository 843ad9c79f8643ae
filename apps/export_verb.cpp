#include <memory>
#include <nlohmann/json.hpp>

#include "apps/verb.hpp"
#include "exchange/export_map.hpp"

namespace roadbook {
namespace {

struct ExportCommand {
  std::filesystem::path map;
  std::string format;
  std::filesystem::path output;
  std::optional<double> latitude;
  std::optional<double> longitude;
  double x_axis = 0.0;
  ExportOptions options;
};

ExportOptions export_options(const ExportCommand& command) {
  ExportOptions options = command.options;
  if (command.latitude.has_value() != command.longitude.has_value())
    throw InvalidOption("--latitude-deg and --longitude-deg", "one of them", "both");
  if (command.latitude && command.longitude)
    options.origin = GeoOrigin{*command.latitude, *command.longitude, command.x_axis};
  return options;
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
            options.add("--output,-o", &command->output, "file to write").required = true;
            options.add("--layer", &command->options.layers, "layer to write; default all");
            options.add("--step-m", &command->options.step_m, "path: between the rows of a lane")
                .range = {0.001, 1000.0};
            options.add("--latitude-deg", &command->latitude, "of the map's origin, WGS84");
            options.add("--longitude-deg", &command->longitude, "of the map's origin, WGS84");
            options.add("--x-axis-deg", &command->x_axis,
                        "direction of the map's x axis, counter-clockwise from east");
          },
          [command](Console& console, const CommonOptions&) {
            const auto files = export_map(command->map, command->format, command->output,
                                          export_options(*command));
            nlohmann::ordered_json list = nlohmann::ordered_json::array();
            for (const auto& file : files) {
              console.say("wrote " + file.string());
              list.push_back(file.string());
            }
            console.result({{"format", command->format}, {"files", list}});
            return ExitStatus::kDone;
          }};
}

}  // namespace roadbook
