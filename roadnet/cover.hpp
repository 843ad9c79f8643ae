#pragma once

#include <vector>

#include "roadnet/graph.hpp"
#include "roadnet/samples.hpp"

namespace roadbook {

/// Returns a cover of the samples: nodes such that every sample is within `reach_m` of one. Nodes
/// are chosen greedily in driving order, and joined in the order in which passes go by them. The
/// number of nodes does not grow with the number of passes over the same road.
[[nodiscard]] RoadGraph cover_graph(const std::vector<PassSamples>& passes, double reach_m);

}  // namespace roadbook
