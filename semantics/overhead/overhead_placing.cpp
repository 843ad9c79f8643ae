#include <algorithm>
#include <cmath>

#include "semantics/overhead/overhead_passes.hpp"

namespace roadbook {
namespace {

std::set<TileIndex> tiles_around(const Eigen::AlignedBox2d& reach, double resolution_m) {
  const double side = kTileSide * resolution_m;
  const auto tile = [side](double metres) { return static_cast<int>(std::floor(metres / side)); };
  std::set<TileIndex> tiles;
  for (int row = tile(-reach.max().y()); row <= tile(-reach.min().y()); ++row)
    for (int column = tile(reach.min().x()); column <= tile(reach.max().x()); ++column)
      tiles.insert({row, column});
  return tiles;
}

}  // namespace

PlacedViews place_views(const OverheadInput& input, const OverheadOptions& options) {
  PlacedViews placed;
  for (const OverheadView& view : input.views) {
    Eigen::Isometry3d T = view.T_map_vehicle;
    const auto z = input.ground.height(T.translation().x(), T.translation().y());
    if (options.stand_on_ground && z) T.translation().z() = *z;
    Eigen::AlignedBox2d reach;
    for (const MountedCamera& mounted : input.rigs[static_cast<std::size_t>(view.rig)].cameras) {
      const Eigen::Vector2d centre = (T * mounted.T_vehicle_camera.translation()).head<2>();
      reach.extend((centre.array() - *options.max_range_m).matrix());
      reach.extend((centre.array() + *options.max_range_m).matrix());
    }
    if (options.area && !reach.isEmpty()) reach = reach.intersection(*options.area);
    placed.tiles.push_back(reach.isEmpty() ? std::set<TileIndex>{}
                                           : tiles_around(reach, options.resolution_m));
    placed.T_map_vehicle.push_back(T);
  }
  return placed;
}

CarMask mask_of(const OverheadInput& input, int rig, std::size_t camera) {
  CarMask mask;
  const auto r = static_cast<std::size_t>(rig);
  if (r < input.masks.size() && camera < input.masks[r].size())
    mask.pixels = &input.masks[r][camera];
  if (r < input.bodies.size()) mask.body = input.bodies[r];
  return mask;
}

}  // namespace roadbook
