#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "base/whole_file.hpp"
#include "drive/output_file.hpp"
#include "exchange/export/export_formats.hpp"
#include "exchange/import/geojson_geometry.hpp"
#include "mapping/layers/map_layers_gdal.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

constexpr std::array<const char*, 1> kBulk{"landmark_points"};

ordered_json value_json(const FieldValue& value) {
  if (const auto* number = std::get_if<std::int64_t>(&value)) return *number;
  if (const auto* real = std::get_if<double>(&value)) return *real;
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  return nullptr;  // bytes have no form in GeoJSON
}

// The class that a layer of places is named for. Outlines from other programs have no column with
// it, and the import of labels needs it.
const char* class_of(const std::string& layer) {
  if (layer == "parking_spaces") return "parking_space";
  return layer == "crossings" ? "crossing" : nullptr;
}

// Features of a layer as lines of a collection; those without a form in degrees are counted.
class LayerText {
 public:
  explicit LayerText(const ToDegrees& to_degrees) : to_degrees_(to_degrees) {}

  void add(const VectorLayer& layer) {
    for (const Feature& feature : layer.features) {
      ordered_json geometry = geojson_geometry(layer.type, feature.points, to_degrees_);
      if (geometry.is_null()) {
        ++left_out_;
        continue;
      }
      ordered_json properties{{"layer", layer.name}};
      for (std::size_t i = 0; i < layer.fields.size(); ++i)
        properties[layer.fields[i].name] = value_json(feature.values[i]);
      if (const char* const named = class_of(layer.name);
          named != nullptr && properties.value("class", ordered_json()).is_null())
        properties["class"] = named;
      const ordered_json json{
          {"type", "Feature"}, {"geometry", std::move(geometry)}, {"properties", properties}};
      text_ += (text_.empty() ? "" : ",\n") +
               json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
    }
  }
  [[nodiscard]] std::string collection() const {
    return "{\"type\":\"FeatureCollection\",\"features\":[\n" + text_ + "\n]}\n";
  }
  [[nodiscard]] std::size_t left_out() const { return left_out_; }

 private:
  const ToDegrees& to_degrees_;
  std::string text_;
  std::size_t left_out_ = 0;
};

// All layers, or those asked for; what is of no use in a text file only where it is asked for.
std::vector<VectorLayer> layers_to_write(const MapLayers& layers,
                                         const ExportOptions& options,
                                         ExportNotes& notes) {
  auto chosen = chosen_vector_layers(layers, options.layers);
  if (!options.layers.empty()) return chosen;
  for (const char* name : kBulk) {
    const auto bulk = std::find_if(chosen.begin(), chosen.end(),
                                   [&](const VectorLayer& layer) { return layer.name == name; });
    if (bulk == chosen.end()) continue;
    add_note(notes, "features of layer " + bulk->name, bulk->features.size(),
             "they are many; --layer " + bulk->name + " writes them");
    chosen.erase(bulk);
  }
  return chosen;
}

Paths write_folder(const std::filesystem::path& folder,
                   const std::vector<VectorLayer>& layers,
                   const ToDegrees& to_degrees,
                   std::size_t& left_out) {
  make_folder(folder);
  Paths files;
  for (const VectorLayer& layer : layers) {
    LayerText text(to_degrees);
    text.add(layer);
    files.push_back(folder / (layer.name + ".geojson"));
    write_whole_file(files.back(), text.collection());
    left_out += text.left_out();
  }
  return files;
}

Paths write_one_file(const std::filesystem::path& out,
                     const std::vector<VectorLayer>& layers,
                     const ToDegrees& to_degrees,
                     std::size_t& left_out) {
  LayerText text(to_degrees);
  for (const VectorLayer& layer : layers) text.add(layer);
  write_whole_file(out, text.collection());
  left_out += text.left_out();
  return {out};
}

}  // namespace

Paths export_geojson(const std::filesystem::path& map,
                     const std::filesystem::path& out,
                     const ExportOptions& options,
                     ExportNotes& notes) {
  const MapLayers layers(map);
  const GeoOrigin origin = require_origin(map, options, "GeoJSON is in degrees");
  const GdalScope scope;
  const ToDegrees to_degrees(origin);
  const auto chosen = layers_to_write(layers, options, notes);
  const bool folder = std::filesystem::is_directory(out) || !out.has_extension();
  std::size_t left_out = 0;
  Paths files = folder ? write_folder(out, chosen, to_degrees, left_out)
                       : write_one_file(out, chosen, to_degrees, left_out);
  add_note(notes, "features round a pole", left_out, "GeoJSON has no form for them");
  return files;
}

}  // namespace roadbook
