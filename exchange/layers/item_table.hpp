#pragma once

#include <cstdint>
#include <vector>

#include "mapping/store/map_file.hpp"
#include "speedmap/items/layer_item.hpp"

namespace roadbook {

/// Appends to table `layer_items`: a row for each item of `put`, with its id, and a row for each id
/// of `expired`, marked at `now_ns`. Rows of the map stay as they are.
void append_items(MapUpdate& update,
                  const MapLayers& before,
                  const std::vector<LayerItem>& put,
                  const std::vector<std::int64_t>& expired,
                  std::int64_t now_ns);

/// All items of the map, by id; empty if it has none. Throws BadInput for a table that contradicts
/// itself.
[[nodiscard]] std::vector<LayerItem> read_items(const MapLayers& layers);

}  // namespace roadbook
