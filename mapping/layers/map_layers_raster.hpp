#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>

#include "mapping/layers/layer_types.hpp"
#include "mapping/layers/map_layers_gdal.hpp"

namespace roadbook {

/// Tiles a GeoTIFF into the GeoPackage `file` with overviews: 8-bit images (1 to 4 bands) as PNG,
/// one band of 16-bit or float values as TIFF tiles; both without loss. The layer must not exist.
/// Throws BadInput for an image that is rotated, has other types or cannot be read; StorageError.
void write_geopackage_raster(const std::filesystem::path& file,
                             const std::string& name,
                             const std::filesystem::path& geotiff,
                             const RasterLayerOptions& options,
                             const std::string& content_time);

/// A raster layer, opened for reading. Throws BadInput.
[[nodiscard]] GdalDataset open_raster_layer(const GdalScope& scope,
                                            const std::filesystem::path& file,
                                            const std::string& name);

/// Halves the raster until it fits one tile. Throws StorageError naming `file`.
void build_overviews(const GdalScope& scope,
                     GDALDataset& dataset,
                     int tile_px,
                     const std::filesystem::path& file);

[[nodiscard]] RasterInfo geopackage_raster_info(const std::filesystem::path& file,
                                                const std::string& name);

/// Throws InvalidOption where the window leaves the raster, BadInput where tiles cannot be decoded.
[[nodiscard]] cv::Mat read_geopackage_raster(const std::filesystem::path& file,
                                             const std::string& name,
                                             const RasterWindow& window);

}  // namespace roadbook
