#pragma once

#include "mapping/layers/map_layers.hpp"
#include "speedmap/speeds/speed_map.hpp"

namespace roadbook {

/// The settings of `roadbook speeds --config`, as JSON in one row.
inline constexpr const char* kSpeedConfigTable = "speed_config";

/// Table `speed_settings` of one row: date, sessions, cell, and the options in JSON.
[[nodiscard]] PlainTable settings_table(const SpeedMap& map);
/// Sets what that table holds. Throws BadInput.
void read_settings(const MapLayers& layers, SpeedMap& map);

}  // namespace roadbook
