#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace roadbook {

// Layers of a map that GIS programs open as they are, without SQL: vector layers, rasters, and
// plain tables. Coordinates are the map frame's, in an engineering coordinate system.

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

/// Reads layers and tables of a finished map. Opening verifies the file as `load_map` does.
class MapLayers {
 public:
  explicit MapLayers(const std::filesystem::path& map);
  MapLayers(MapLayers&&) noexcept;
  MapLayers& operator=(MapLayers&&) noexcept;
  ~MapLayers();

  [[nodiscard]] const std::filesystem::path& file() const;
  /// Of all vector and raster layers, by name.
  [[nodiscard]] std::vector<LayerInfo> list() const;
  [[nodiscard]] bool has(const std::string& name) const;
  /// Names of all layers and tables except the map's own tables and those of the file format,
  /// ascending.
  [[nodiscard]] std::vector<std::string> all_names() const;

  /// All throw BadInput where the map has no such layer, naming the nearest.
  [[nodiscard]] VectorLayer read_layer(const std::string& name) const;
  [[nodiscard]] RasterInfo raster_info(const std::string& name) const;
  /// Pixels of the window, channels as bands, 8, 16 or 32 bit as stored. Throws InvalidOption for a
  /// window that leaves the raster.
  [[nodiscard]] cv::Mat read_raster(const std::string& name, const RasterWindow& window) const;
  [[nodiscard]] PlainTable read_table(const std::string& name) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roadbook
