#pragma once

#include <vector>

#include "roadnet/network.hpp"

namespace roadbook {

/// Where `driven` leaves the network: samples farther than its reach from all lanes, gathered in
/// stretches. Parts of passes within two reaches of a stretch add to it; the longest part gives its
/// ends. Sorted by the length driven there, longest first. `vertical_limit_m` apart in height
/// counts as one reach. About linear in the driven length.
[[nodiscard]] std::vector<UncoveredStretch> uncovered_stretches(
    const RoadNetwork& network, const std::vector<DrivenPass>& driven, double vertical_limit_m);

}  // namespace roadbook
