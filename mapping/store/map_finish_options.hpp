#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "mapping/layers/layer_types.hpp"

namespace roadbook {

/// What a finished map has besides its own tables.
struct MapFinishOptions {
  /// Keep layers and tables of the existing MAP (labels, overhead image, ...): for a map that is
  /// extended, not rebuilt.
  bool keep_other_layers = false;
  /// Tables of the MAP that is there which are taken over as they are, where it has them: what was
  /// measured and does not depend on this build's coordinates.
  std::vector<std::string> keep_tables;
  /// Layers in addition to the map's own, in its coordinates.
  std::vector<VectorLayer> layers;
  /// With more landmarks the layer `landmark_points` is left out (half a second per 100,000), which
  /// `map_meta` records. The landmarks themselves are always stored.
  std::size_t max_landmark_points = 200'000;
};

}  // namespace roadbook
