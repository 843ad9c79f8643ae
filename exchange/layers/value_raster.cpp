#include "exchange/layers/value_raster.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <system_error>

#include "base/colour_ramp.hpp"
#include "base/error.hpp"

namespace roadbook {
namespace {

constexpr int kBlock = GeoTiffWriter::kBlock;

// A GeoTIFF on its way into the map.
class PassingFile {
 public:
  explicit PassingFile(const std::string& name)
      : path_(std::filesystem::temp_directory_path() /
              ("roadbook_" + std::to_string(::getpid()) + "_" + name + ".tif")) {}
  ~PassingFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  PassingFile(const PassingFile&) = delete;
  PassingFile& operator=(const PassingFile&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// Fills every block of a band; `pixel(value)` for each cell, outside the raster of NaN.
template <typename Pixel>
void write_band(GeoTiffWriter& writer,
                int band,
                const ValueRaster& raster,
                const std::function<Pixel(float)>& pixel) {
  const RasterPlace& place = raster.place;
  std::vector<Pixel> block(static_cast<std::size_t>(kBlock) * kBlock);
  for (int by = 0; by * kBlock < place.rows; ++by)
    for (int bx = 0; bx * kBlock < place.columns; ++bx) {
      for (int y = 0; y < kBlock; ++y)
        for (int x = 0; x < kBlock; ++x) {
          const int row = by * kBlock + y;
          const int column = bx * kBlock + x;
          const bool in = row < place.rows && column < place.columns;
          block[static_cast<std::size_t>(y * kBlock + x)] =
              pixel(in ? raster.values[static_cast<std::size_t>(row) *
                                           static_cast<std::size_t>(place.columns) +
                                       static_cast<std::size_t>(column)]
                       : NAN);
        }
      writer.write_block(band, bx, by, block.data());
    }
}

}  // namespace

ValueRaster ValueRaster::over(const Eigen::Vector2d& low,
                              const Eigen::Vector2d& high,
                              double resolution_m) {
  ROADBOOK_ASSERT((high - low).minCoeff() >= 0.0 && resolution_m > 0.0);
  const auto cells = [&] { return ((high - low) / resolution_m).array() + 2.0; };
  while (cells().prod() > std::exp2(24.0)) resolution_m *= 2.0;
  ValueRaster raster;
  RasterPlace& place = raster.place;
  place.resolution_m = resolution_m;
  place.west_m = std::floor(low.x() / resolution_m + 1e-9) * resolution_m;
  place.north_m = std::ceil(high.y() / resolution_m - 1e-9) * resolution_m;
  place.columns =
      std::max(1, static_cast<int>(std::ceil((high.x() - place.west_m) / resolution_m - 1e-9)));
  place.rows =
      std::max(1, static_cast<int>(std::ceil((place.north_m - low.y()) / resolution_m - 1e-9)));
  raster.values.assign(
      static_cast<std::size_t>(place.columns) * static_cast<std::size_t>(place.rows), NAN);
  return raster;
}

std::size_t ValueRaster::index_of(const Eigen::Vector2d& p) const {
  const auto clamped = [](double at, int count) {
    return static_cast<std::size_t>(std::clamp(std::floor(at), 0.0, count - 1.0));
  };
  return clamped((place.north_m - p.y()) / place.resolution_m, place.rows) *
             static_cast<std::size_t>(place.columns) +
         clamped((p.x() - place.west_m) / place.resolution_m, place.columns);
}

void write_value_raster(MapUpdate& update,
                        const std::string& name,
                        const std::string& description,
                        const ValueRaster& raster) {
  const PassingFile file(name);
  GeoTiffWriter writer(file.path(), raster.place, PixelType::kFloat32, 1, kNoValue, description);
  write_band<float>(writer, 1, raster, [](float value) {
    return std::isnan(value) ? static_cast<float>(kNoValue) : value;
  });
  writer.finish(OverviewMethod::kNearest);
  update.write_raster(name, file.path(), {description, 256});
}

void write_colour_raster(MapUpdate& update,
                         const std::string& name,
                         const std::string& description,
                         const ValueRaster& raster,
                         double calm,
                         double danger) {
  const PassingFile file(name);
  GeoTiffWriter writer(file.path(), raster.place, PixelType::kByte, 4, 0.0, description);
  for (int band = 1; band <= 4; ++band)
    write_band<std::uint8_t>(writer, band, raster, [&](float value) -> std::uint8_t {
      if (std::isnan(value)) return 0;
      if (band == 4) return 255;
      return colour_ramp((value - calm) / (danger - calm))[static_cast<std::size_t>(band - 1)];
    });
  writer.finish(OverviewMethod::kNearest);
  update.write_raster(name, file.path(), {description, 256});
}

}  // namespace roadbook
