#pragma once

#include <vector>

#include "base/progress.hpp"
#include "mapping/edits/map_edit.hpp"
#include "mapping/map.hpp"
#include "mapping/pipeline/map_options.hpp"

namespace roadbook {

/// The map with edits: its pose graph is relaxed with them, places that then meet are searched for
/// common landmarks, and everything is adjusted from stored observations. No recording is read.
/// Map frames do not move. Adjusted covariances replace the old ones.
///
/// An edit must agree with the map: Refused names the accepted loops of the map, the steps of
/// odometry or the other edits that contradict it. BadInput for places that the map does not have;
/// Interrupted. Deterministic on any number of threads.
[[nodiscard]] Map edited_map(const Map& map,
                             const std::vector<MapEdit>& edits,
                             const MapOptions& options,
                             const Progress& progress = {});

}  // namespace roadbook
