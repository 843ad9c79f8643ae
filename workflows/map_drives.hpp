#pragma once

#include <filesystem>
#include <vector>

#include "base/messages.hpp"
#include "exchange/layers/dropped_work.hpp"
#include "mapping/pipeline/build_map.hpp"

namespace roadbook {

/// The arguments of `map_drives`.
struct MapRequest {
  std::vector<std::filesystem::path> drives;  ///< oldest first
  std::filesystem::path map;                  ///< to write, or to extend
  std::filesystem::path model;                ///< YAML of known effects; empty: none
  std::filesystem::path vehicle;  ///< YAML with measures of the vehicle; empty: as the drives say
  bool equal_rows = false;        ///< labelled rows of equal spaces straighten the map
  MapOptions options;
};

struct MapResult {
  MapSummary summary;
  std::vector<DroppedWork> dropped;  ///< layers that the new map does not have, with their commands
};

/// Builds a map from drives, or extends an existing map by drives that it does not have. Labels,
/// measured and learned tables of the map are kept. Reports through `messages` how the drives of an
/// existing map are used.
/// Throws what `build_map` throws.
[[nodiscard]] MapResult map_drives(const MapRequest& request, Messages& messages);

}  // namespace roadbook
