#include "exchange/export/export_map.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/text.hpp"
#include "exchange/export/export_formats.hpp"
#include "exchange/export/nav2/nav2_occupancy.hpp"
#include "semantics/labels/label_layers.hpp"

namespace roadbook {

namespace {

void require_one_of(const char* option,
                    const std::string& value,
                    const std::vector<std::string>& choices) {
  if (std::find(choices.begin(), choices.end(), value) != choices.end()) return;
  std::string known;
  for (const std::string& choice : choices) known += (known.empty() ? "" : ", ") + choice;
  throw InvalidOption(option, value, "one of " + known);
}

}  // namespace

void GeoOrigin::check() const {
  if (!(latitude_deg >= -89.0 && latitude_deg <= 89.0))
    throw InvalidOption("origin latitude", std::to_string(latitude_deg), "-89 to 89 degrees");
  if (!(longitude_deg >= -180.0 && longitude_deg <= 180.0))
    throw InvalidOption("origin longitude", std::to_string(longitude_deg), "-180 to 180 degrees");
  if (!(x_axis_deg >= -360.0 && x_axis_deg <= 360.0))
    throw InvalidOption("origin x axis", std::to_string(x_axis_deg), "-360 to 360 degrees");
}

void ExportOptions::check() const {
  if (!(step_m >= 0.001 && step_m <= 1000.0))
    throw InvalidOption("step_m", std::to_string(step_m), "0.001 to 1000");
  if (!(resolution_m >= 0.01 && resolution_m <= 5.0))
    throw InvalidOption("--resolution-m", std::to_string(resolution_m), "0.01 to 5");
  if (vehicle) vehicle->check();
  require_one_of("profile", profile, lanelet2_profiles());
  require_one_of("country", country, commonroad_countries());
}

const std::vector<std::string>& export_formats() {
  static const std::vector<std::string> formats{
      "tum", "geojson", "geotiff", "gpkg", "path", "lanelet2",  "opendrive",
      "spm", "nav2",    "coco",    "yolo", "qgis", "commonroad"};
  return formats;
}

std::vector<std::string> chosen_rasters(const MapLayers& layers,
                                        const std::vector<std::string>& asked) {
  if (!asked.empty()) return asked;
  std::vector<std::string> names;
  for (const LayerInfo& layer : layers.list())
    if (layer.raster) names.push_back(layer.name);
  if (names.empty())
    throw BadInput(Problem{Severity::kError, layers.file().string(), 0, "layers", "no raster layer",
                           "a map that has one"});
  return names;
}

std::vector<VectorLayer> chosen_vector_layers(const MapLayers& layers,
                                              const std::vector<std::string>& asked) {
  const auto today = label_layers_of_today(layers);
  const auto names = asked.empty() ? vector_layers_of_today(layers, today) : asked;
  if (names.empty())
    throw BadInput(Problem{Severity::kError, layers.file().string(), 0, "layers", "no vector layer",
                           "a map that has one"});
  std::vector<VectorLayer> chosen;
  for (const std::string& name : names) {
    auto layer = layer_of_today(layers, today, name);
    chosen.push_back(layer ? std::move(*layer) : layers.read_layer(name));
  }
  return chosen;
}

std::vector<std::filesystem::path> export_map(const std::filesystem::path& map,
                                              const std::string& format,
                                              const std::filesystem::path& out,
                                              const ExportOptions& options,
                                              ExportNotes* notes) {
  options.check();
  ExportNotes left_out;
  ExportNotes& noted = notes != nullptr ? *notes : left_out;
  if (format == "tum") return export_tum(map, out);
  if (format == "coco") return export_coco(map, out);
  if (format == "yolo") return export_yolo(map, out);
  if (format == "geojson") return export_geojson(map, out, options, noted);
  if (format == "geotiff") return export_geotiff(map, out, options);
  if (format == "gpkg") return export_gpkg(map, out, options);
  if (format == "path") return export_path(map, out, options);
  if (format == "spm") return export_spm(map, out, options);
  if (format == "nav2" && !options.layers.empty()) {
    for (const std::string& layer : options.layers)
      if (layer != "occupancy")
        throw InvalidOption("--layer", layer, "occupancy for nav2, or none for the masks");
    return export_nav2_occupancy(map, out);
  }
  if (format == "nav2") return export_nav2(map, out, options, noted);
  if (format == "qgis") return export_qgis(map, out);
  if (format == "lanelet2") return export_lanelet2(map, out, options, noted);
  if (format == "commonroad") return export_commonroad(map, out, options, noted);
  if (format == "opendrive") return export_opendrive(map, out, options, noted);
  std::string known;
  for (const std::string& name : export_formats()) known += (known.empty() ? "" : ", ") + name;
  const auto nearest = nearest_name(format, export_formats());
  throw InvalidOption("format", format,
                      nearest ? *nearest + " (did you mean that?) or one of " + known : known);
}

}  // namespace roadbook
