#include <cmath>
#include <nlohmann/json.hpp>

#include "exchange/export_formats.hpp"
#include "exchange/geo_origin.hpp"
#include "exchange/output_file.hpp"
#include "mapping/map_layers_gdal.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

/// Longitude, latitude [degrees], height [m], rounded to 0.1 mm.
ordered_json coordinates_json(const Eigen::Vector4d& p, const ToDegrees& to_degrees) {
  const auto rounded = [](double value, double scale) { return std::round(value * scale) / scale; };
  const Eigen::Vector2d degrees = to_degrees(p.head<2>());
  return ordered_json::array(
      {rounded(degrees.x(), 1e9), rounded(degrees.y(), 1e9), rounded(p.z(), 1e4)});
}

ordered_json geometry_json(const VectorLayer& layer,
                           const Feature& feature,
                           const ToDegrees& to_degrees) {
  ordered_json points = ordered_json::array();
  for (const Eigen::Vector4d& p : feature.points) points.push_back(coordinates_json(p, to_degrees));
  if (layer.type == GeometryType::kLineStringZ)
    return {{"type", "LineString"}, {"coordinates", points}};
  if (layer.type == GeometryType::kPolygonZ)
    return {{"type", "Polygon"}, {"coordinates", ordered_json::array({points})}};
  return {{"type", "Point"},
          {"coordinates", points.empty() ? ordered_json::array() : points.front()}};
}

ordered_json value_json(const FieldValue& value) {
  if (const auto* number = std::get_if<std::int64_t>(&value)) return *number;
  if (const auto* real = std::get_if<double>(&value)) return *real;
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  return nullptr;  // bytes have no form in GeoJSON
}

std::string layer_text(const VectorLayer& layer, const ToDegrees& to_degrees, bool first) {
  std::string text;
  for (const Feature& feature : layer.features) {
    ordered_json properties{{"layer", layer.name}};
    for (std::size_t i = 0; i < layer.fields.size(); ++i)
      properties[layer.fields[i].name] = value_json(feature.values[i]);
    const ordered_json json{{"type", "Feature"},
                            {"geometry", geometry_json(layer, feature, to_degrees)},
                            {"properties", properties}};
    text +=
        (first ? "" : ",\n") + json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
    first = false;
  }
  return text;
}

}  // namespace

Paths export_geojson(const std::filesystem::path& map,
                     const std::filesystem::path& out,
                     const ExportOptions& options) {
  const MapLayers layers(map);
  const GeoOrigin origin = require_origin(map, options, "GeoJSON is in degrees");
  const GdalScope scope;
  const ToDegrees to_degrees(origin);
  std::string text = "{\"type\":\"FeatureCollection\",\"features\":[\n";
  bool first = true;
  for (const VectorLayer& layer : chosen_vector_layers(layers, options.layers)) {
    const std::string features = layer_text(layer, to_degrees, first);
    first = first && features.empty();
    text += features;
  }
  write_text_file(out, text + "\n]}\n");
  return {out};
}

}  // namespace roadbook
