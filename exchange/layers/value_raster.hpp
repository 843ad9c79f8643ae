#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mapping/store/map_file.hpp"
#include "semantics/overhead/geotiff_writer.hpp"

namespace roadbook {

/// Values on a grid in the map's plane; NaN: unknown. Row 0 is the northernmost.
struct ValueRaster {
  RasterPlace place;
  std::vector<float> values;

  /// A raster over [low, high] [m] with square cells of about `resolution_m`, all NaN. Cells are
  /// larger if there would be more than 2^24. Its lines lie at whole multiples of the resolution.
  static ValueRaster over(const Eigen::Vector2d& low,
                          const Eigen::Vector2d& high,
                          double resolution_m);
  /// Index of the cell that holds the point; it must lie inside.
  [[nodiscard]] std::size_t index_of(const Eigen::Vector2d& p) const;
};

/// No value in rasters of numbers.
constexpr double kNoValue = -9999.0;

/// Writes the values as a raster layer of Float32.
void write_value_raster(MapUpdate& update,
                        const std::string& name,
                        const std::string& description,
                        const ValueRaster& raster);
/// Writes the values as an image (red, green, blue, opacity) that any program displays: value
/// `calm` is dark, value `danger` yellow.
void write_colour_raster(MapUpdate& update,
                         const std::string& name,
                         const std::string& description,
                         const ValueRaster& raster,
                         double calm,
                         double danger);

}  // namespace roadbook
