#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "exchange/layers/occupancy_layers.hpp"
#include "mapping/map.hpp"
#include "workflows/occupancy/occupancy_score.hpp"
#include "workflows/occupancy/true_surfaces.hpp"

namespace roadbook {

/// Cells under the way of the vehicle's origin, half a metre to each side: known to be free,
/// because the vehicle was there. Needs no truth.
struct DrivenGround {
  std::size_t cells = 0;
  std::size_t seen = 0;  ///< of them, that a reading reached
  std::size_t free = 0;
  std::size_t occupied = 0;
};
[[nodiscard]] DrivenGround driven_ground(const OccupancyGrid& grid,
                                         double prior_log_odds,
                                         const Map& map);

/// A grid against the seven demands of document 001 on a representation of the environment.
struct OccupancyDemands {
  OccupancyFigures figures;
  double cell_m = 0.1;
  std::vector<OccupancyDrive> drives;
  DrivenGround driven;
  std::optional<OccupancyTruth> truth;    ///< empty if the true surfaces are not known
  std::optional<OccupancyTrails> trails;  ///< empty if it is not known where people walked

  [[nodiscard]] double area_m2() const;
  /// Changes of cells by one scan (for cameras: by one keyframe), over all drives.
  [[nodiscard]] double updates_a_scan() const;
  /// Shares of the cells that a reading reached.
  [[nodiscard]] double undecided_share() const;
  [[nodiscard]] double free_share() const;
};

[[nodiscard]] OccupancyDemands occupancy_demands(const StoredOccupancy& stored,
                                                 const OccupancyGrid& grid,
                                                 const Map& map,
                                                 const std::optional<TruePlace>& place);

/// The demands of the grid that a map has, at the present poses of the map. The truth is used where
/// the newest drive of the grid is a session whose simulated drive is available. Empty without a
/// grid. Throws BadInput.
[[nodiscard]] std::optional<OccupancyDemands> demands_of_map(const std::filesystem::path& map_file,
                                                             const Map& map);

}  // namespace roadbook
