#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "exchange/layers/path_layers.hpp"

namespace roadbook {

/// What path exports are made from: network and paths of a map, and what tells a consumer whether
/// to trust them.
struct StoredPaths {
  RoadNetwork network;
  std::vector<LanePath> paths;
  NetworkSource source;
  std::string digest;  ///< of the map
};

/// Throws BadInput where `roads` has not been run on the map, or was by a version without paths.
void require_paths(const MapLayers& layers);

/// Network and paths of a map. Throws BadInput.
[[nodiscard]] StoredPaths load_paths(const std::filesystem::path& map);

/// A number with so many decimals; never "-0.000".
[[nodiscard]] std::string fixed_text(double value, int decimals);

}  // namespace roadbook
