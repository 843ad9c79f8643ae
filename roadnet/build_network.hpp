#pragma once

#include <vector>

#include "roadnet/network.hpp"
#include "roadnet/network_options.hpp"

namespace roadbook {

// Builds the road network from driven positions [metric-semantic maps, section V-B]. The driven
// positions are first thinned to a cover, so that the number of nodes does not grow with the number
// of passes. The cover is then pruned until it is a skeleton. All passes of all sessions are used
// at once, because pruning session by session loses roads.

/// Finds lanes and intersections of the driven roads. `passes`: positions [m, map]. Lanes start at
/// intersections or dead ends. Every part of the skeleton is in exactly one lane. Roads that a pass
/// connects are connected. Centres follow the mean of the driven positions. With `previous`, lanes
/// and intersections that still exist keep their ids; new ids depend on their position alone.
/// `stages`, if not null, receives the intermediate graphs.
///
/// Passes that never move give an empty network of status kEmpty. Deterministic, single-threaded,
/// about linear in the driven length. Throws InvalidOption, and BadInput for positions that are not
/// finite.
[[nodiscard]] RoadNetwork build_road_network(const std::vector<DrivenPass>& passes,
                                             const RoadNetworkOptions& options = {},
                                             const RoadNetwork* previous = nullptr,
                                             RoadNetworkStages* stages = nullptr);

}  // namespace roadbook
