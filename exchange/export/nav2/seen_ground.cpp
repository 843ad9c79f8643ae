#include "exchange/export/nav2/seen_ground.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>

#include "semantics/overhead/ground_model.hpp"
#include "semantics/overhead/visible_ground.hpp"

namespace roadbook {
namespace {

constexpr double kSight_m = 20.0;   // an overhead image shows no ground farther from a camera
constexpr double kSpacing_m = 0.5;  // between keyframes that are looked from
constexpr double kOwnCar_m = 1.5;   // no other object can be where the own car is
constexpr int kBandRows = 64;       // of the grid, for which the image is read at once

const char* shown_layer(const MapLayers& layers) {
  for (const char* name : {"overhead_count", "overhead"})
    if (layers.has(name)) return name;
  return nullptr;
}

// Pixels whose middles lie between two lines of the grid; without such pixels, the nearest one.
struct PixelRange {
  int first = 0;
  int last = 0;
  PixelRange(double from_px, double to_px, int count) {
    first = static_cast<int>(std::ceil(from_px - 0.5));
    last = static_cast<int>(std::ceil(to_px - 0.5)) - 1;
    if (last < first) first = last = static_cast<int>(std::floor(0.5 * (from_px + to_px)));
    whole = last - first + 1;
    first = std::max(first, 0);
    last = std::min(last, count - 1);
  }
  int whole = 0;  ///< pixels, those outside the image too
};

// Sets 1 in cells where at least half of the area is shown.
void mark_shown(const MapLayers& layers, MaskGrid& grid) {
  const char* const layer = shown_layer(layers);
  if (layer == nullptr) return;
  const RasterInfo info = layers.raster_info(layer);
  const RasterPlace& place = grid.place();
  const auto rows = [&](int row) {
    const double top = (info.corner.y() - place.north_m) / info.resolution_m;
    const double step = place.resolution_m / info.resolution_m;
    return PixelRange(top + row * step, top + (row + 1) * step, info.height);
  };
  const auto columns = [&](int column) {
    const double left = (place.west_m - info.corner.x()) / info.resolution_m;
    const double step = place.resolution_m / info.resolution_m;
    return PixelRange(left + column * step, left + (column + 1) * step, info.width);
  };
  for (int begin = 0; begin < place.rows; begin += kBandRows) {
    const int end = std::min(begin + kBandRows, place.rows);
    const int top = std::min(rows(begin).first, rows(end - 1).first);
    const int bottom = std::max(rows(begin).last, rows(end - 1).last);
    if (bottom < top) continue;
    const cv::Mat shown = layers.read_raster(layer, {0, top, info.width, bottom - top + 1}) != 0;
    for (int row = begin; row < end; ++row) {
      const PixelRange y = rows(row);
      for (int column = 0; column < place.columns; ++column) {
        const PixelRange x = columns(column);
        if (y.last < y.first || x.last < x.first) continue;
        const cv::Rect window(x.first, y.first - top, x.last - x.first + 1, y.last - y.first + 1);
        if (2 * cv::countNonZero(shown(window)) >= x.whole * y.whole)
          grid.cells()[grid.index(column, row)] = 1;
      }
    }
  }
}

void look_round(const Eigen::Vector2d& eye, const MaskGrid& standing, MaskGrid& visible) {
  const double step = standing.place().resolution_m;
  const int rays = static_cast<int>(std::ceil(2.0 * std::numbers::pi * kSight_m / step));
  const int steps = static_cast<int>(kSight_m / step);
  for (int k = 0; k < rays; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / rays;
    const Eigen::Vector2d along = step * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    Eigen::Vector2d p = eye;
    for (int i = 0; i < steps; ++i, p += along) {
      const int column = standing.column_of(p.x());
      const int row = standing.row_of(p.y());
      if (!standing.holds(column, row)) continue;
      const std::size_t at = standing.index(column, row);
      if (standing.cells()[at] != 0 && i * step > kOwnCar_m) break;
      visible.cells()[at] = 1;
    }
  }
}

// Middle of the cameras of a keyframe.
Eigen::Vector2d eye_of(const Map& map, std::size_t keyframe) {
  const auto session = static_cast<std::size_t>(map.keyframes[keyframe].session);
  const auto& cameras = map.sessions[session].rig.cameras;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const MountedCamera& camera : cameras) middle += camera.T_vehicle_camera.translation();
  if (!cameras.empty()) middle /= static_cast<double>(cameras.size());
  return (map.T_map_vehicle(static_cast<int>(keyframe)) * middle).head<2>();
}

void mark_visible(const Map& map, const MaskGrid& standing, MaskGrid& visible) {
  Eigen::Vector2d last = Eigen::Vector2d::Constant(INFINITY);
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    const Eigen::Vector2d eye = eye_of(map, k);
    if ((eye - last).norm() < kSpacing_m) continue;
    last = eye;
    look_round(eye, standing, visible);
  }
}

}  // namespace

Eigen::AlignedBox2d overhead_extent(const MapLayers& layers) {
  Eigen::AlignedBox2d box;
  if (const char* const layer = shown_layer(layers)) {
    const RasterInfo info = layers.raster_info(layer);
    box.extend(info.corner);
    box.extend(info.corner + info.resolution_m * Eigen::Vector2d(info.width, -info.height));
  }
  return box;
}

void mark_seen_ground(const MapLayers& layers, const Map& map, MaskGrid& grid) {
  const VisibleGroundOptions options;
  MaskGrid standing = grid;
  const double half = 0.5 * options.cell_m;
  for (const Eigen::Vector2d& cell : standing_cells(map, estimate_ground(map), options))
    standing.mark({cell + Eigen::Vector2d(-half, -half), cell + Eigen::Vector2d(half, -half),
                   cell + Eigen::Vector2d(half, half), cell + Eigen::Vector2d(-half, half)},
                  1);
  MaskGrid visible = grid;
  mark_visible(map, standing, visible);
  MaskGrid shown = grid;
  mark_shown(layers, shown);
  for (std::size_t i = 0; i < grid.cells().size(); ++i)
    grid.cells()[i] = standing.cells()[i] != 0                           ? kOccupiedGround
                      : shown.cells()[i] != 0 && visible.cells()[i] != 0 ? kFreeGround
                                                                         : kUnseenGround;
}

}  // namespace roadbook
