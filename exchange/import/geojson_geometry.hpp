#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "exchange/export/geo_origin.hpp"
#include "mapping/layers/map_layers.hpp"

namespace roadbook {

/// A geometry by RFC 7946: longitude, latitude [degrees], height [m], rounded to 0.1 mm; rings
/// counter-clockwise. A geometry that crosses the meridian of 180 degrees is cut there (section
/// 3.1.9) and becomes a MultiLineString or MultiPolygon.
/// Null for a ring around a pole, which has no form in degrees.
[[nodiscard]] nlohmann::ordered_json geojson_geometry(GeometryType type,
                                                      const std::vector<Eigen::Vector4d>& points,
                                                      const ToDegrees& to_degrees);

/// The name of a coordinate reference system (member `crs` of the standard of 2008) that is not
/// WGS84 in the order longitude, latitude; empty for WGS84 and where the file names none.
[[nodiscard]] std::optional<std::string> foreign_reference(const nlohmann::json& crs);

/// The ring of `coordinates` of a MultiPolygon whose parts, one ring each, meet at the meridian of
/// 180 degrees, as `geojson_geometry` cuts them. Its longitudes continue beyond 180; corners of the
/// cut are removed. Null if the parts are no such ring.
[[nodiscard]] nlohmann::json joined_at_antimeridian(const nlohmann::json& coordinates);

}  // namespace roadbook
