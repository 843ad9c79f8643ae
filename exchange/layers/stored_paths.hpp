#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "exchange/layers/path_layers.hpp"

namespace roadbook {

/// Input of the path exports: network and paths of a map, and the values that show a consumer
/// whether to trust them.
struct StoredPaths {
  RoadNetwork network;
  std::vector<LanePath> paths;
  NetworkSource source;
  std::string digest;  ///< of the map
};

/// Throws BadInput if `roads` was not run on the map, or was run by a version without paths.
void require_paths(const MapLayers& layers);

/// Network and paths of a map. Throws BadInput.
[[nodiscard]] StoredPaths load_paths(const std::filesystem::path& map);
[[nodiscard]] StoredPaths load_paths(const MapLayers& layers);

/// A number with `decimals` decimals; never "-0.000".
[[nodiscard]] std::string fixed_text(double value, int decimals);

}  // namespace roadbook
