#pragma once

#include <vector>

#include "mapping/map.hpp"
#include "roadnet/network.hpp"

namespace roadbook {

/// The passes driven in a map, as the road network wants them: a new one where a session begins,
/// after a gap, and where the driving direction changes (both passes then hold the turning point).
[[nodiscard]] std::vector<DrivenPass> driven_passes(const Map& map);

/// Way along all passes [m].
[[nodiscard]] double driven_length_m(const std::vector<DrivenPass>& passes);

}  // namespace roadbook
