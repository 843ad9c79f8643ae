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
  std::filesystem::path vehicle;  ///< YAML with measures of the vehicle; empty: measures of the
                                  ///< drives
  bool equal_rows = false;        ///< labelled rows of equal spaces straighten the map
  MapOptions options;
};

struct MapResult {
  MapSummary summary;
  std::vector<DroppedWork> dropped;  ///< layers that the new map lacks, with the commands that make
                                     ///< them
  std::vector<std::filesystem::path> drives;  ///< of the map, in its order
};

/// Builds a map from drives, or extends an existing map with drives that it lacks. Keeps labels and
/// the tables of measured and learned values. Reports through `messages` how it uses the drives of
/// an existing map. Throws the exceptions of `build_map`.
[[nodiscard]] MapResult map_drives(const MapRequest& request, Messages& messages);

}  // namespace roadbook
