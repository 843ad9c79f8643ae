#pragma once

#include <vector>

#include "mapping/map.hpp"
#include "roadnet/network.hpp"

namespace roadbook {

/// Divides the trajectory of a map into passes for the road network. A new pass begins with each
/// session, after a gap, and where the driving direction changes. At a change of direction, both
/// passes contain the turning point.
[[nodiscard]] std::vector<DrivenPass> driven_passes(const Map& map);

/// Returns the total length of all passes [m].
[[nodiscard]] double driven_length_m(const std::vector<DrivenPass>& passes);

}  // namespace roadbook
