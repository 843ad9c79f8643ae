#pragma once

#include <filesystem>
#include <optional>
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
  /// An existing map is built again from the recordings of all its drives and the new ones, instead
  /// of extended.
  bool batch = false;
  std::optional<SessionAdjust> adjust;  ///< empty: near, or all with `equal_rows`
  MapOptions options;
};

struct MapResult {
  MapSummary summary;
  std::vector<DroppedWork> dropped;  ///< layers that the new map lacks, with the commands that make
                                     ///< them
  std::vector<std::filesystem::path> drives;  ///< of the map, in its order
};

/// Builds a map from drives. If the map exists, it is extended by the drives that it lacks, one
/// after another (`extend_map`); with `batch` it is built again from the recordings of all. Keeps
/// labels and the tables of measured and learned values. Reports through `messages` how it uses an
/// existing map. Throws the exceptions of `build_map` and `extend_map`.
[[nodiscard]] MapResult map_drives(const MapRequest& request, Messages& messages);

}  // namespace roadbook
