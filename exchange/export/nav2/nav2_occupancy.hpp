#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "exchange/export/export_formats.hpp"

namespace roadbook {

// The occupancy grid for Nav2's map_server.

/// Grey value of a cell in a map of mode trinary: free (`is_free`), occupied from probability 0.65,
/// else, and where nothing is known (NaN), 205. With `free_thresh` 0.196 this grey stays unknown;
/// with 0.25, a value in common use, map_server reads it as free.
[[nodiscard]] std::uint8_t trinary_pixel(float probability, float sigma);
/// Grey value in a map of mode scale with thresholds 0 and 1.
[[nodiscard]] std::uint8_t scale_pixel(float probability);

/// Writes `out`.pgm and .yaml (trinary), and `out`_scale.png and .yaml (scale: probability in per
/// cent). Mode scale gives a value to every grey, so that unknown cells are transparent, which PGM
/// cannot express. Throws BadInput for a map without the layer, StorageError.
Paths export_nav2_occupancy(const std::filesystem::path& map, const std::filesystem::path& out);

}  // namespace roadbook
