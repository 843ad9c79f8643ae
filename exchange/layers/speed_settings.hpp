#pragma once

#include "mapping/layers/map_layers.hpp"
#include "speedmap/speeds/speed_map.hpp"

namespace roadbook {

/// Name of the table that holds the settings of `roadbook speeds --config`, as JSON in one row.
inline constexpr const char* kSpeedConfigTable = "speed_config";

/// Makes table `speed_settings` with one row: date, sessions, cell size, and the options in JSON.
[[nodiscard]] PlainTable settings_table(const SpeedMap& map);
/// Reads that table into `map`. Throws BadInput.
void read_settings(const MapLayers& layers, SpeedMap& map);

}  // namespace roadbook
