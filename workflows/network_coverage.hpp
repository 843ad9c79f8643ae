#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "roadnet/network.hpp"

namespace roadbook {

/// Returns warnings about driven ground that is not on the network: its share, and the stretches
/// with the largest missing length (at most five). Empty if the network has no uncovered stretch.
[[nodiscard]] std::vector<Problem> coverage_warnings(const RoadNetwork& network,
                                                     const std::string& file,
                                                     double min_coverage);

/// All uncovered stretches, most driven first: `from` and `to` as [x, y, z] in the map frame [m],
/// `driven_m`, `passes`.
[[nodiscard]] nlohmann::ordered_json uncovered_json(const RoadNetwork& network);

}  // namespace roadbook
