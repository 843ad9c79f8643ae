#pragma once

#include <vector>

#include "roadnet/network.hpp"

namespace roadbook {

/// Returns the stretches where `driven` leaves the network: samples farther than its reach from all
/// lanes. Uncovered parts of passes within two reaches of each other form one stretch; the longest
/// part gives its ends. Sorted by driven length, longest first. A difference in height of
/// `vertical_limit_m` counts as one reach. About linear in the driven length.
[[nodiscard]] std::vector<UncoveredStretch> uncovered_stretches(
    const RoadNetwork& network, const std::vector<DrivenPass>& driven, double vertical_limit_m);

}  // namespace roadbook
