#pragma once

#include <optional>

#include "exchange/layers/network_layers.hpp"
#include "mapping/map.hpp"

namespace roadbook {

/// The road network of a map; empty where `roads` has not been run.
[[nodiscard]] std::optional<RoadNetwork> stored_network(const MapLayers& layers);

/// Sessions, age and uncertainty of the poses that a map's network is made from.
[[nodiscard]] NetworkSource source_of(const Map& map);

}  // namespace roadbook
