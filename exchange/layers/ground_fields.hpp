#pragma once

#include <cstdint>
#include <optional>

#include "mapping/layers/map_layers.hpp"
#include "speedmap/fields/label_field.hpp"
#include "speedmap/fields/occupancy_field.hpp"

namespace roadbook {

/// The occupancy grid from the map's rasters, with the age of each cell at `now_ns`; empty if the
/// map has none. Throws BadInput for rasters that contradict each other.
[[nodiscard]] std::optional<OccupancyField> read_occupancy_field(const MapLayers& layers,
                                                                 std::int64_t now_ns);

/// The outlines of layers `parking_spaces`, `crossings` and `other_labels`; empty if the map has
/// none of them. Throws BadInput.
[[nodiscard]] std::optional<LabelField> read_label_field(const MapLayers& layers);

}  // namespace roadbook
