#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "exchange/export/nav2/mask_grid.hpp"
#include "exchange/export/nav2/vehicle_footprint.hpp"
#include "exchange/export/planner/planner_map.hpp"

namespace roadbook {

/// Where a vehicle may stand and where not.
struct KeepOutMask {
  MaskGrid grid;          ///< 1: free; 0: to be kept out of
  bool overhead = false;  ///< the map has an overhead image: ground outside of the lanes is known
  /// Ids of parking spaces to which no free ground wide enough for the vehicle leads from a lane.
  std::vector<std::string> cut_off;
};

/// Free is what was seen free (seen_ground.hpp), and whatever else may be there:
///
/// - what the vehicle touches on the way along a lane or a turn, in each direction in which it was
///   driven, with 0.1 m and a cell to spare, and the width that was driven;
/// - parking spaces, crossings, and the ground straight before a space as far as its lane.
///
/// Free, unless something is known to stand there, is also what the vehicle sweeps when it reverses
/// from the lane into the space. All else is to be kept out of: also what nobody has seen, as
/// Nav2's keep-out filter lets a planner use unknown cells.
///
/// `map` and `planner` were read from `map_file`. Throws InvalidOption, BadInput.
[[nodiscard]] KeepOutMask keep_out_mask(const std::filesystem::path& map_file,
                                        const Map& map,
                                        const PlannerMap& planner,
                                        const VehicleFootprint& vehicle,
                                        double resolution_m);

}  // namespace roadbook
