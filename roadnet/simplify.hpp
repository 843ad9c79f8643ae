#pragma once

#include <vector>

#include "roadnet/graph.hpp"
#include "roadnet/samples.hpp"

namespace roadbook {

/// Makes the driven cover a skeleton: prunes cliques until none is larger than 2, merges loops and
/// pairs of intersections that are too small to be roads at this reach, and removes spurs that
/// lead nowhere. Samples further than the reach from the rest keep their spur: a driven dead end.
void simplify(RoadGraph& graph, const std::vector<PassSamples>& passes, double reach_m);

/// Removes nodes without edges.
void remove_isolated(RoadGraph& graph);

/// Removes dead ends shorter than three times the reach whose samples are all within reach of the
/// rest. Returns whether there were any.
bool remove_spurs(RoadGraph& graph, const std::vector<PassSamples>& passes, double reach_m);

/// Removes dead ends shorter than `min_length_m`, and parts of the graph that are a single lane as
/// short. Returns whether there were any.
bool remove_short_dead_ends(RoadGraph& graph, double min_length_m);

}  // namespace roadbook
