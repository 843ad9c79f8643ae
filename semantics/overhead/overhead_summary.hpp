#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "semantics/overhead/overhead_input.hpp"

namespace roadbook {

/// Instant of a frame number in the layers.
struct OverheadFrame {
  int session = 0;
  int keyframe = 0;
  std::int64_t t_ns = 0;
};

/// A block of the raster and the ranges of frames that contributed to it, such as "0-14 80-92".
struct OverheadBlock {
  int column = 0;
  int row = 0;
  std::string frames;
};

/// Effect of the exposure balance on the image.
struct OverheadExposure {
  /// False if balancing was switched off, or was dropped because it saturated more than
  /// `kMostSaturatedMore` of the ground in addition to what is saturated as recorded.
  bool balanced = false;
  double least_gain = 1.0;
  double most_gain = 1.0;
  double saturated = 0.0;           ///< share of the observed ground, with these gains
  double saturated_recorded = 0.0;  ///< the same for the recorded brightness
};
inline constexpr double kMostSaturatedMore = 0.01;

struct OverheadSummary {
  std::filesystem::path image;     ///< 8 bit, nodata 0
  std::filesystem::path count;     ///< 16 bit: images that contributed, nodata 0
  std::filesystem::path variance;  ///< float: variance of the grey values averaged, nodata -1
  std::filesystem::path
      frames;  ///< 3 bands of 32 bit: frame with most weight, first, last; nodata 2^32-1
  std::filesystem::path frame_table;  ///< CSV: frame -> session, keyframe, stamp
  std::filesystem::path tile_table;   ///< CSV: every tile's contributing frames
  int columns = 0;
  int rows = 0;
  double west_m = 0.0;   ///< map x of the left border
  double north_m = 0.0;  ///< map y of the upper border
  double resolution_m = 0.0;
  double covered_m2 = 0.0;
  double coverage = 0.0;    ///< share of the raster's rectangle that was observed
  double sigma_grey = 0.0;  ///< square root of the mean variance of the observed pixels
  OverheadExposure exposure;
  std::vector<OverheadFrame> frame_list;  ///< all views; the frame number is the index
  std::vector<OverheadBlock> blocks;      ///< blocks with content, from the north-west
  std::size_t views = 0;
  std::size_t images_used = 0;
  std::size_t images_missing = 0;
  std::size_t tiles = 0;
  std::size_t tiles_spilled = 0;     ///< number of times a tile was moved to the scratch folder
  double max_range_m = 0.0;          ///< as used
  std::vector<VehicleUse> vehicles;  ///< by rig; for a Map by session
  double exposure_seconds = 0.0;
  double mosaic_seconds = 0.0;
  double write_seconds = 0.0;
  std::vector<Problem> warnings;
};

}  // namespace roadbook
