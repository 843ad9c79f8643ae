#include <ogr_spatialref.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/error.hpp"
#include "base/text.hpp"
#include "exchange/export_formats.hpp"
#include "exchange/output_file.hpp"
#include "mapping/map_file.hpp"
#include "mapping/map_layers_gdal.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::ordered_json;

/// Map frame to WGS84: turned to east and north, then by PROJ from an azimuthal equidistant
/// projection about the origin, which keeps distance and direction from there.
class ToDegrees {
 public:
  explicit ToDegrees(const GeoOrigin& origin)
      : turn_(origin.x_axis_deg * std::numbers::pi / 180.0) {
    const std::string local = "+proj=aeqd +lat_0=" + std::to_string(origin.latitude_deg) +
                              " +lon_0=" + std::to_string(origin.longitude_deg) +
                              " +datum=WGS84 +units=m +no_defs";
    OGRSpatialReference from;
    OGRSpatialReference to;
    ROADBOOK_ASSERT(from.importFromProj4(local.c_str()) == OGRERR_NONE);
    ROADBOOK_ASSERT(to.importFromEPSG(4326) == OGRERR_NONE);
    to.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    transformation_.reset(OGRCreateCoordinateTransformation(&from, &to));
    ROADBOOK_ASSERT(transformation_ != nullptr);
  }

  /// Longitude, latitude [degrees], height [m], rounded to 0.1 mm.
  [[nodiscard]] Json operator()(const Eigen::Vector4d& p) const {
    double x = std::cos(turn_) * p.x() - std::sin(turn_) * p.y();
    double y = std::sin(turn_) * p.x() + std::cos(turn_) * p.y();
    ROADBOOK_ASSERT(transformation_->Transform(1, &x, &y) == TRUE);
    return Json::array({rounded(x, 1e9), rounded(y, 1e9), rounded(p.z(), 1e4)});
  }

 private:
  static double rounded(double value, double scale) { return std::round(value * scale) / scale; }

  struct Destroy {
    void operator()(OGRCoordinateTransformation* t) const {
      OGRCoordinateTransformation::DestroyCT(t);
    }
  };
  double turn_;
  std::unique_ptr<OGRCoordinateTransformation, Destroy> transformation_;
};

std::optional<GeoOrigin> stored_origin(const std::filesystem::path& map) {
  const MapMeta meta = load_meta(map);
  const auto number = [&](const char* key) -> std::optional<double> {
    const auto entry = meta.values.find(key);
    return entry == meta.values.end() ? std::nullopt : parse_double(entry->second);
  };
  const auto latitude = number("origin_latitude_deg");
  const auto longitude = number("origin_longitude_deg");
  if (!latitude || !longitude) return std::nullopt;
  return GeoOrigin{*latitude, *longitude, number("origin_x_axis_deg").value_or(0.0)};
}

Json geometry_json(const VectorLayer& layer, const Feature& feature, const ToDegrees& to_degrees) {
  Json points = Json::array();
  for (const Eigen::Vector4d& p : feature.points) points.push_back(to_degrees(p));
  if (layer.type == GeometryType::kLineStringZ)
    return {{"type", "LineString"}, {"coordinates", points}};
  if (layer.type == GeometryType::kPolygonZ)
    return {{"type", "Polygon"}, {"coordinates", Json::array({points})}};
  return {{"type", "Point"}, {"coordinates", points.empty() ? Json::array() : points.front()}};
}

Json value_json(const FieldValue& value) {
  if (const auto* number = std::get_if<std::int64_t>(&value)) return *number;
  if (const auto* real = std::get_if<double>(&value)) return *real;
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  return nullptr;  // bytes have no form in GeoJSON
}

std::string layer_text(const VectorLayer& layer, const ToDegrees& to_degrees, bool first) {
  std::string text;
  for (const Feature& feature : layer.features) {
    Json properties{{"layer", layer.name}};
    for (std::size_t i = 0; i < layer.fields.size(); ++i)
      properties[layer.fields[i].name] = value_json(feature.values[i]);
    const Json json{{"type", "Feature"},
                    {"geometry", geometry_json(layer, feature, to_degrees)},
                    {"properties", properties}};
    text += (first ? "" : ",\n") + json.dump(-1, ' ', false, Json::error_handler_t::replace);
    first = false;
  }
  return text;
}

}  // namespace

Paths export_geojson(const std::filesystem::path& map,
                     const std::filesystem::path& out,
                     const ExportOptions& options) {
  const MapLayers layers(map);
  const std::optional<GeoOrigin> origin = options.origin ? options.origin : stored_origin(map);
  if (!origin)
    throw BadInput(Problem{Severity::kError, map.string(), 0, "origin", "none",
                           "latitude and longitude of the map's origin: GeoJSON is in degrees"});
  origin->check();
  const GdalScope scope;
  const ToDegrees to_degrees(*origin);
  std::string text = "{\"type\":\"FeatureCollection\",\"features\":[\n";
  bool first = true;
  for (const std::string& name : chosen_layers(layers, options.layers, false)) {
    const std::string features = layer_text(layers.read_layer(name), to_degrees, first);
    first = first && features.empty();
    text += features;
  }
  write_text_file(out, text + "\n]}\n");
  return {out};
}

}  // namespace roadbook
