#include "semantics/overhead/overhead_files.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iomanip>
#include <limits>
#include <sstream>
#include <string>

#include "base/error.hpp"
#include "base/files/disk_space.hpp"

namespace roadbook {
namespace {

struct Extent {
  TileIndex north_west{std::numeric_limits<int>::max(), std::numeric_limits<int>::max()};
  TileIndex south_east{std::numeric_limits<int>::min(), std::numeric_limits<int>::min()};
};

Extent extent_of(const std::vector<TileIndex>& tiles) {
  Extent e;
  for (const TileIndex t : tiles) {
    e.north_west = {std::min(e.north_west.row, t.row), std::min(e.north_west.column, t.column)};
    e.south_east = {std::max(e.south_east.row, t.row), std::max(e.south_east.column, t.column)};
  }
  return e;
}

RasterPlace place_of(const Extent& e, double resolution_m) {
  return {(e.south_east.column - e.north_west.column + 1) * kTileSide,
          (e.south_east.row - e.north_west.row + 1) * kTileSide,
          e.north_west.column * kTileSide * resolution_m,
          -e.north_west.row * kTileSide * resolution_m, resolution_m};
}

// "0-14 80-92": the frames of a tile as ranges.
std::string ranges(const std::vector<std::uint32_t>& frames) {
  std::string text;
  for (std::size_t i = 0; i < frames.size();) {
    std::size_t j = i;
    while (j + 1 < frames.size() && frames[j + 1] == frames[j] + 1) ++j;
    if (!text.empty()) text += ' ';
    text += std::to_string(frames[i]);
    if (j > i) text += "-" + std::to_string(frames[j]);
    i = j + 1;
  }
  return text;
}

void close(std::ofstream* file, const std::filesystem::path& path) {
  file->close();
  if (!*file)
    throw StorageError("error: " + path.string() + ": writing: got " + write_fault(path) +
                       ", want a disk that takes it");
}

void write_tables(const OverheadSummary& summary) {
  std::ofstream frames(summary.frame_table);
  frames << "#frame,session,keyframe,timestamp [ns]\n";
  for (std::size_t i = 0; i < summary.frame_list.size(); ++i) {
    const OverheadFrame& frame = summary.frame_list[i];
    frames << i << ',' << frame.session << ',' << frame.keyframe << ',' << frame.t_ns << '\n';
  }
  close(&frames, summary.frame_table);
  std::ofstream blocks(summary.tile_table);
  blocks << "#block_column,block_row,frames\n";
  for (const OverheadBlock& block : summary.blocks)
    blocks << block.column << ',' << block.row << ',' << block.frames << '\n';
  close(&blocks, summary.tile_table);
}

struct Layers {
  GeoTiffWriter image;
  GeoTiffWriter count;
  GeoTiffWriter variance;
  GeoTiffWriter frames;

  Layers(const OverheadSummary& s, const RasterPlace& place)
      : image(s.image, place, PixelType::kByte, 1, 0, "overhead image"),
        count(s.count, place, PixelType::kUInt16, 1, 0, "images averaged per pixel"),
        variance(s.variance, place, PixelType::kFloat32, 1, -1, "variance of the grey values"),
        frames(s.frames,
               place,
               PixelType::kUInt32,
               3,
               kNoFrame,
               "frame of most weight, first and last frame") {}

  void write(const MosaicTile& tile, Brightness brightness, int block_column, int block_row) {
    image.write_block(1, block_column, block_row, tile.image(brightness).data());
    count.write_block(1, block_column, block_row, tile.count().data());
    variance.write_block(1, block_column, block_row, tile.variance(brightness).data());
    frames.write_block(1, block_column, block_row, tile.best().data());
    frames.write_block(2, block_column, block_row, tile.first().data());
    frames.write_block(3, block_column, block_row, tile.last().data());
  }
  void finish() {
    image.finish(OverviewMethod::kAverage);
    count.finish(OverviewMethod::kNearest);
    variance.finish(OverviewMethod::kNearest);
    frames.finish(OverviewMethod::kNearest);
  }
};

// Totals over the pixels of all tiles.
struct Content {
  std::size_t covered = 0;
  double variance = 0.0;

  void add(const MosaicTile& tile, Brightness brightness) {
    for (const float variance_of_pixel : tile.variance(brightness)) {
      if (variance_of_pixel < 0.0F) continue;
      ++covered;
      variance += static_cast<double>(variance_of_pixel);
    }
  }
};

constexpr std::uint8_t kSaturated = 250;  // from here on, paint and bright ground look the same

// Measures the share of the ground that is saturated, in both brightnesses.
void measure_saturation(TileStore* store, OverheadExposure* exposure) {
  std::size_t seen = 0;
  std::size_t balanced = 0;
  std::size_t recorded = 0;
  for (const TileIndex index : store->indices()) {
    const MosaicTile& tile = *store->acquire({index}).front();
    for (const std::uint8_t grey : tile.image(Brightness::kBalanced)) {
      if (grey > 0) ++seen;
      if (grey >= kSaturated) ++balanced;
    }
    for (const std::uint8_t grey : tile.image(Brightness::kRecorded))
      if (grey >= kSaturated) ++recorded;
  }
  if (seen == 0) return;
  exposure->saturated = static_cast<double>(balanced) / static_cast<double>(seen);
  exposure->saturated_recorded = static_cast<double>(recorded) / static_cast<double>(seen);
}

std::string percent(double share) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << 100.0 * share << " %";
  return text.str();
}

// Drops a balance that saturates the image. The loss of detail is worse than brightness steps
// between images.
Brightness choose_brightness(TileStore* store, OverheadSummary* summary) {
  OverheadExposure& exposure = summary->exposure;
  measure_saturation(store, &exposure);
  if (!exposure.balanced) return Brightness::kRecorded;
  if (exposure.saturated <= exposure.saturated_recorded + kMostSaturatedMore)
    return Brightness::kBalanced;
  exposure.balanced = false;
  summary->warnings.push_back(
      {Severity::kWarning, summary->image.string(), 0, "exposure balance",
       percent(exposure.saturated) + " of the ground saturated, " +
           percent(exposure.saturated_recorded) + " without the balance",
       "at most 1 % more; the image keeps the brightness that was recorded"});
  return Brightness::kRecorded;
}

void name_files(const std::filesystem::path& out, OverheadSummary* summary) {
  summary->image = out / "overhead.tif";
  summary->count = out / "overhead_count.tif";
  summary->variance = out / "overhead_variance.tif";
  summary->frames = out / "overhead_frames.tif";
  summary->frame_table = out / "overhead_frames.csv";
  summary->tile_table = out / "overhead_tiles.csv";
}

[[noreturn]] void refuse_without_ground(const OverheadSummary& summary) {
  std::ostringstream range;
  range << std::setprecision(3) << summary.max_range_m;
  throw Refused("error: overhead image: ground: got none in " +
                std::to_string(summary.images_used) + " images, want ground within " + range.str() +
                " m of a camera (--max-range-m) and not hidden by the own vehicle (--vehicle)");
}

}  // namespace

void write_overhead(const OverheadInput& input,
                    const std::filesystem::path& out,
                    const OverheadOptions& options,
                    const Progress& progress,
                    TileStore* store,
                    OverheadSummary* summary) {
  const std::vector<TileIndex> touched = store->indices();
  if (touched.empty()) throw Refused("no view reaches the area of the overhead image");
  const Extent extent = extent_of(touched);
  const RasterPlace place = place_of(extent, options.resolution_m);
  name_files(out, summary);
  summary->columns = place.columns;
  summary->rows = place.rows;
  summary->west_m = place.west_m;
  summary->north_m = place.north_m;
  summary->resolution_m = place.resolution_m;

  const Brightness brightness = choose_brightness(store, summary);
  Layers layers(*summary, place);
  for (const OverheadView& view : input.views)
    summary->frame_list.push_back({view.session, view.keyframe, view.t_ns});
  Content content;
  for (std::size_t i = 0; i < touched.size(); ++i) {
    report(progress, "writing", i, touched.size());
    const MosaicTile& tile = *store->acquire({touched[i]}).front();
    if (tile.frames().empty()) continue;
    ++summary->tiles;
    content.add(tile, brightness);
    const int column = touched[i].column - extent.north_west.column;
    const int row = touched[i].row - extent.north_west.row;
    layers.write(tile, brightness, column, row);
    summary->blocks.push_back({column, row, ranges(tile.frames())});
  }
  if (content.covered == 0) refuse_without_ground(*summary);
  layers.finish();
  write_tables(*summary);
  const auto covered = static_cast<double>(content.covered);
  summary->covered_m2 = covered * options.resolution_m * options.resolution_m;
  summary->coverage = covered / (static_cast<double>(place.columns) * place.rows);
  summary->sigma_grey = std::sqrt(content.variance / covered);
}

}  // namespace roadbook
