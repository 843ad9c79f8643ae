#pragma once

#include <cstddef>
#include <vector>

#include "roadnet/graph.hpp"

namespace roadbook {

/// The neighbours of a clique that are removed with it [metric-semantic maps, algorithm 1,
/// lines 23-24].
enum class SpurRule {
  kKeep,       ///< none: another step decides on dead ends
  kHangsOnIt,  ///< nodes with no neighbour outside the clique
  kDegreeOne,  ///< as the paper states: degree 1 after the clique's edges were added
};

/// Finds the maximal cliques of more than two nodes, largest first, equal ones by their nodes.
/// Throws Refused if there are more than `limit`: their number grows exponentially with the passes.
[[nodiscard]] std::vector<std::vector<int>> large_cliques(const RoadGraph& graph,
                                                          std::size_t limit);

/// Merges `nodes` into the node nearest to their mean and returns this node. The other nodes lose
/// their edges and stay as isolated nodes.
int contract(RoadGraph& graph, const std::vector<int>& nodes);

/// One pruning loop of algorithm 1 (lines 14-25): cliques of more than two nodes are replaced by
/// their node nearest to the centre. Returns whether there was any.
bool prune_once(RoadGraph& graph, SpurRule spurs, std::size_t clique_limit = 2'000'000);

}  // namespace roadbook
