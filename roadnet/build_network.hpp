#pragma once

#include <vector>

#include "roadnet/network.hpp"
#include "roadnet/network_options.hpp"

namespace roadbook {

// The road network from driven positions [metric-semantic maps, section V-B], in the default mode.
// The driven positions are first thinned to a cover, so that the number of nodes does not grow with
// the number of passes. The cover is pruned until it is a skeleton. All passes of all sessions go
// in at once; pruning session by session loses roads.

/// Lanes and intersections of the driven roads. Lanes start at intersections or dead ends, every
/// part of the skeleton is in exactly one lane, and what was driven connected is connected. Centres
/// follow the mean of the driven positions. With `previous`, lanes and intersections that are still
/// there keep their ids; new ids depend on their place alone.
///
/// Passes that never move give an empty network of status kEmpty. Deterministic, single-threaded,
/// about linear in the driven length. Throws InvalidOption, and BadInput for positions that are
/// not finite.
[[nodiscard]] RoadNetwork build_road_network(const std::vector<DrivenPass>& passes,
                                             const RoadNetworkOptions& options = {},
                                             const RoadNetwork* previous = nullptr,
                                             RoadNetworkStages* stages = nullptr);

}  // namespace roadbook
