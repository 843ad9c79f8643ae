#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "roadnet/network.hpp"

namespace roadbook {

/// Warnings about what was driven and is not on the network: the share, and the stretches where
/// most is missing (at most five). Empty where the network lists no uncovered stretch.
[[nodiscard]] std::vector<Problem> coverage_warnings(const RoadNetwork& network,
                                                     const std::string& file,
                                                     double min_coverage);

/// All uncovered stretches, most driven first: `from` and `to` as [x, y, z] in the map frame [m],
/// `driven_m`, `passes`.
[[nodiscard]] nlohmann::ordered_json uncovered_json(const RoadNetwork& network);

}  // namespace roadbook
