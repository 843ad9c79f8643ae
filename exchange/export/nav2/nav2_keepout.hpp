#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "exchange/export/nav2/mask_grid.hpp"
#include "exchange/export/nav2/vehicle_footprint.hpp"
#include "exchange/export/planner/planner_map.hpp"

namespace roadbook {

/// The ground on which a vehicle may be.
struct KeepOutMask {
  MaskGrid grid;          ///< 1: free; 0: keep out
  bool overhead = false;  ///< the map has an overhead image, so ground off the lanes is known
  /// Ids of parking spaces without a free path from a lane that is wide enough for the vehicle.
  std::vector<std::string> cut_off;
};

/// Computes the mask. These areas are free, even if an object was seen there:
///
/// - the area that the vehicle sweeps along a lane or a turn, in each driven direction, with a
/// margin
///   of 0.1 m and one cell, and the driven width;
/// - parking spaces, crossings, and the ground straight between a space and its lane.
///
/// Ground that was seen free (seen_ground.hpp) is free too. So is the area that the vehicle sweeps
/// when it reverses from the lane into the space, unless an object is known there. All other cells
/// are kept out, also unseen ground, because Nav2's keep-out filter lets a planner use unknown
/// cells.
///
/// `map` and `planner` were read from `map_file`. Throws InvalidOption, BadInput.
[[nodiscard]] KeepOutMask keep_out_mask(const std::filesystem::path& map_file,
                                        const Map& map,
                                        const PlannerMap& planner,
                                        const VehicleFootprint& vehicle,
                                        double resolution_m);

}  // namespace roadbook
