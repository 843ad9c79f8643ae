#pragma once

#include <optional>

#include "exchange/layers/network_layers.hpp"
#include "mapping/map.hpp"

namespace roadbook {

/// Returns the road network of a map. Empty if `roads` has not been run.
[[nodiscard]] std::optional<RoadNetwork> stored_network(const MapLayers& layers);

/// Returns sessions, age and uncertainty of the poses from which a map's network is made.
[[nodiscard]] NetworkSource source_of(const Map& map);

}  // namespace roadbook
