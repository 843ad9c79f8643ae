#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "mapping/layers/layer_types.hpp"

namespace roadbook {

// Layers of a map that GIS programs open as they are, without SQL: vector layers, rasters, and
// plain tables. Coordinates are the map frame's, in an engineering coordinate system.

/// What a reader of layers compares with the digests that the map holds.
enum class VerifiedPart {
  kAll,         ///< the whole file when it is opened, as `load_map`
  kWhatIsRead,  ///< the list of tables when it is opened, each table before it is read: quick
};

/// Reads layers and tables of a finished map. Throws BadInput, here or when a layer is read, for
/// damage in the part that is verified.
class MapLayers {
 public:
  explicit MapLayers(const std::filesystem::path& map, VerifiedPart verified = VerifiedPart::kAll);
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

/// Names as of `MapLayers::all_names`. Quick: no layer is read.
[[nodiscard]] std::vector<std::string> layer_names(const std::filesystem::path& map);

}  // namespace roadbook
