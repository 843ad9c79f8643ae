#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace roadbook {

// Writes large GeoTIFFs block by block, in map metres with the CRS of the map frame (map_crs_wkt in
// mapping/layers/map_layers.hpp).

enum class PixelType { kByte, kUInt16, kUInt32, kFloat32 };
enum class OverviewMethod { kAverage, kNearest };

/// Extent of a raster: north-up, square pixels.
struct RasterPlace {
  int columns = 0;
  int rows = 0;
  double west_m = 0.0;   ///< x of the left border
  double north_m = 0.0;  ///< y of the upper border
  double resolution_m = 0.0;
};

/// A tiled, compressed GeoTIFF that is written block by block. Blocks that are never written
/// contain no data and take no space. All members throw StorageError.
class GeoTiffWriter {
 public:
  static constexpr int kBlock = 256;  ///< side of a block [px]

  GeoTiffWriter(const std::filesystem::path& path,
                const RasterPlace& place,
                PixelType type,
                int bands,
                double nodata,
                const std::string& description);
  ~GeoTiffWriter();
  GeoTiffWriter(GeoTiffWriter&&) noexcept;
  GeoTiffWriter& operator=(GeoTiffWriter&&) noexcept;

  /// `pixels`: kBlock * kBlock values of the file's pixel type, first row in the north. `band` from
  /// 1.
  void write_block(int band, int block_column, int block_row, const void* pixels);
  /// Builds overviews until one block holds the image, and closes the file.
  void finish(OverviewMethod method);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roadbook
