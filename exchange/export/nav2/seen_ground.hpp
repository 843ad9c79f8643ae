#pragma once

#include <Eigen/Geometry>

#include "exchange/export/nav2/mask_grid.hpp"
#include "mapping/layers/map_layers.hpp"
#include "mapping/map.hpp"

namespace roadbook {

// The ground that the cameras saw, in the cells of a mask.

inline constexpr std::uint8_t kUnseenGround = 0;
inline constexpr std::uint8_t kFreeGround = 1;
inline constexpr std::uint8_t kOccupiedGround = 2;

/// The part of the plane that the overhead image covers [m]; empty where the map lacks the image.
[[nodiscard]] Eigen::AlignedBox2d overhead_extent(const MapLayers& layers);

/// Sets the cells of a grid. Occupied: an object is there (raised landmarks, visible_ground.hpp).
/// Free: the overhead image shows at least half of the cell, and a straight line from the cameras
/// of a keyframe reaches it without an occupied cell; the image behind a wall shows no ground.
/// Unseen: all other cells, and every cell of a map without an overhead image.
void mark_seen_ground(const MapLayers& layers, const Map& map, MaskGrid& grid);

}  // namespace roadbook
