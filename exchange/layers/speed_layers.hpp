#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "mapping/store/map_file.hpp"
#include "roadnet/paths/lane_path.hpp"
#include "speedmap/presence/map_ages.hpp"
#include "speedmap/speeds/lane_speeds.hpp"
#include "speedmap/speeds/speed_map.hpp"

namespace roadbook {

/// Writes layers `dynamic_map` (a point for each cell) and `speed_profile` (points along each
/// lane), rasters `speed_map`, `speed_sigma` [m/s] and `speed_colours`, and tables `layer_ages` and
/// `speed_settings`, replacing older ones.
void write_speed_layers(MapUpdate& update, const SpeedMap& map);

/// Reads the speed map, without ages; empty if `speeds` was never run. Throws BadInput for layers
/// that contradict each other.
[[nodiscard]] std::optional<SpeedMap> read_speed_layers(const MapLayers& layers);

/// Whether the stored speeds were made on these paths; true if no speeds are stored.
[[nodiscard]] bool speeds_fit(const MapLayers& layers, const std::vector<LanePath>& paths);

/// `read_speed_layers` for exports and planners. Throws BadInput, with the command to run, if the
/// paths of the map changed after the speeds were made.
[[nodiscard]] std::optional<SpeedMap> read_current_speeds(const MapLayers& layers,
                                                          const std::vector<LanePath>& paths);

}  // namespace roadbook
