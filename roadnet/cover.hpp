#pragma once

#include <vector>

#include "roadnet/graph.hpp"
#include "roadnet/samples.hpp"

namespace roadbook {

/// Places such that every sample is within `reach_m` of one, chosen greedily in driving order, and
/// joined in the order they were driven past. The number of places does not grow with the number of
/// passes over the same road.
[[nodiscard]] RoadGraph cover_graph(const std::vector<PassSamples>& passes, double reach_m);

}  // namespace roadbook
