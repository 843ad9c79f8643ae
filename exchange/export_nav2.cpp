#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "exchange/export_formats.hpp"
#include "exchange/output_file.hpp"
#include "exchange/path_layers.hpp"
#include "exchange/speed_layers.hpp"
#include "exchange/stored_paths.hpp"
#include "exchange/value_raster.hpp"

// Masks for Nav2's costmap filters. Speed: `mode: raw`, so that pixels 1 to 100 are the values; 0
// would mean "no limit" and is never written. Keep-out: where no lane and no space is.

namespace roadbook {
namespace {

struct Mask {
  RasterPlace place;
  std::string pixels;
};

std::string pgm(const Mask& mask) {
  return "P5\n" + std::to_string(mask.place.columns) + " " + std::to_string(mask.place.rows) +
         "\n255\n" + mask.pixels;
}

std::string map_yaml(const Mask& mask, const std::string& image, const std::string& mode) {
  const RasterPlace& place = mask.place;
  return "image: " + image + "\nmode: " + mode +
         "\nresolution: " + fixed_text(place.resolution_m, 6) + "\norigin: [" +
         fixed_text(place.west_m, 6) + ", " +
         fixed_text(place.north_m - place.rows * place.resolution_m, 6) +
         ", 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.25\n";
}

std::string filter_yaml(int type, const char* name, double base = 0.0, double multiplier = 1.0) {
  return "costmap_filter_info_server:\n  ros__parameters:\n    type: " + std::to_string(type) +
         "\n    filter_info_topic: \"" + name + "_info\"\n    mask_topic: \"" + name +
         "_mask\"\n    base: " + fixed_text(base, 3) +
         "\n    multiplier: " + fixed_text(multiplier, 3) + "\n";
}

// Tenths of a metre per second, more where the largest speed would need more than 100 of them.
double step_of(double max_speed) { return std::max(0.1, std::ceil(max_speed) / 100.0); }

}  // namespace

Paths export_nav2(const std::filesystem::path& map, const std::filesystem::path& out) {
  const MapLayers layers(map);
  const auto speeds = layers.has("lane_paths")
                          ? read_current_speeds(layers, read_path_layers(layers))
                          : std::nullopt;
  if (!speeds)
    throw BadInput(Problem{Severity::kError, map.string(), 0, "speed_map", "none",
                           "a speed map: run `roadbook speeds` on the map"});
  Eigen::Vector2d low = Eigen::Vector2d::Constant(INFINITY);
  Eigen::Vector2d high = -low;
  for (const SpeedCell& cell : speeds->cells) {
    low = low.cwiseMin(cell.centre);
    high = high.cwiseMax(cell.centre);
  }
  const Eigen::Vector2d half = Eigen::Vector2d::Constant(0.5 * speeds->cell_m);
  const ValueRaster raster = ValueRaster::over(low - half, high + half, speeds->cell_m);
  const double multiplier = step_of(speeds->options.max_speed);
  // Pixel 0 means "no limit", so the least speed must be pixel 1 or more.
  const double base =
      std::min(0.0, std::floor(1e3 * (speeds->options.min_speed - multiplier)) / 1e3);
  const auto pixel_of = [&](double speed) {
    // Down to a whole step: never faster than the map.
    return static_cast<char>(
        std::clamp(std::floor((speed - base) / multiplier + 1e-9), 1.0, 100.0));
  };
  Mask speed{raster.place, std::string(raster.values.size(), pixel_of(speeds->options.min_speed))};
  Mask keepout{raster.place, std::string(raster.values.size(), '\0')};
  for (const SpeedCell& cell : speeds->cells) {
    const std::size_t at = raster.index_of(cell.centre);
    speed.pixels[at] = pixel_of(cell.speed);
    if (cell.place != PlaceClass::kOther) keepout.pixels[at] = static_cast<char>(254);
  }
  Paths files;
  const auto write = [&](const std::string& suffix, const std::string& text) {
    files.push_back(out.parent_path() / (out.stem().string() + suffix));
    write_text_file(files.back(), text);
  };
  const std::string stem = out.stem().string();
  write(".pgm", pgm(speed));
  write(".yaml", map_yaml(speed, stem + ".pgm", "raw"));
  write("_filter.yaml", filter_yaml(2, "speed_filter", base, multiplier));
  write("_keepout.pgm", pgm(keepout));
  write("_keepout.yaml", map_yaml(keepout, stem + "_keepout.pgm", "trinary"));
  write("_keepout_filter.yaml", filter_yaml(0, "keepout_filter"));
  return files;
}

}  // namespace roadbook
