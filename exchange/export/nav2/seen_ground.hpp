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

/// Sets the cells of a grid. Occupied: something stands there (raised landmarks,
/// visible_ground.hpp). Free: at least half of the cell is shown by the overhead image, and a
/// straight line leads to it from the cameras of a keyframe without passing an occupied cell; what
/// the image shows behind a wall is not ground. Unseen: all else, everything where the map has no
/// overhead image.
void mark_seen_ground(const MapLayers& layers, const Map& map, MaskGrid& grid);

}  // namespace roadbook
