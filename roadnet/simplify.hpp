#pragma once

#include <vector>

#include "roadnet/graph.hpp"
#include "roadnet/samples.hpp"

namespace roadbook {

/// Reduces the cover to a skeleton. Prunes cliques until none is larger than 2. Merges loops and
/// pairs of intersections that are too small to be roads at this reach. Removes spurs. A spur with
/// samples farther than the reach from the rest of the graph is a driven dead end and stays.
void simplify(RoadGraph& graph, const std::vector<PassSamples>& passes, double reach_m);

/// Removes nodes without edges.
void remove_isolated(RoadGraph& graph);

/// Removes dead ends shorter than three times the reach whose samples are all within reach of the
/// rest. Returns whether there were any.
bool remove_spurs(RoadGraph& graph, const std::vector<PassSamples>& passes, double reach_m);

/// Removes dead ends shorter than `min_length_m`, and components that are a single lane shorter
/// than that. Returns whether there were any.
bool remove_short_dead_ends(RoadGraph& graph, double min_length_m);

}  // namespace roadbook
