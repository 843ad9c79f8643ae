#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace roadbook {

// The contents of layers and tables, and the definitions that all layers of a map have in common.

/// Well-known text of the map frame: metres, x and y, tied to no place on the earth. All vector
/// layers, rasters and GeoTIFFs have this one definition.
[[nodiscard]] const std::string& map_crs_wkt();

/// "2024-05-17T08:30:00.123Z" of a stamp in nanoseconds since 1970: the age of what a layer shows.
[[nodiscard]] std::string utc_text(std::int64_t t_ns);

using Bytes = std::vector<std::uint8_t>;
/// Empty (null), whole number, number, text, bytes.
using FieldValue = std::variant<std::monostate, std::int64_t, double, std::string, Bytes>;
enum class FieldType { kInteger, kReal, kText, kBytes };

struct Field {
  std::string name;  ///< letters, digits, underscores; with its unit where it has one: "width_m"
  FieldType type = FieldType::kText;
};

enum class GeometryType { kPointZ, kPointZM, kLineStringZ, kPolygonZ };

struct Feature {
  /// x, y, z [m, map frame] and, for PointZM, the measure. A polygon is its outer ring, first point
  /// repeated at the end.
  std::vector<Eigen::Vector4d> points;
  std::vector<FieldValue> values;  ///< one for each field
};

struct VectorLayer {
  std::string name;
  std::string description;
  GeometryType type = GeometryType::kPointZ;
  std::vector<Field> fields;
  std::vector<Feature> features;

  /// Position of the field of that name, if there is one.
  [[nodiscard]] std::optional<std::size_t> field(const std::string& field_name) const;
};

struct PlainTable {
  std::string name;
  std::vector<Field> fields;
  std::vector<std::vector<FieldValue>> rows;
};

struct RasterLayerOptions {
  std::string description;
  int tile_px = 256;
};

struct LayerInfo {
  std::string name;
  std::string description;
  bool raster = false;
};

struct RasterInfo {
  int width = 0;   ///< [px]
  int height = 0;  ///< [px]
  int bands = 0;
  /// Outer corner of the first pixel [m]; x grows with columns, y falls with rows.
  Eigen::Vector2d corner = Eigen::Vector2d::Zero();
  double resolution_m = 0.0;  ///< of one pixel
};

/// A part of a raster [px].
struct RasterWindow {
  int column = 0;
  int row = 0;
  int width = 0;
  int height = 0;
};

}  // namespace roadbook
