#pragma once

#include <cstddef>
#include <vector>

#include "roadnet/graph.hpp"

namespace roadbook {

/// Which neighbours of a clique disappear with it [metric-semantic maps, algorithm 1, lines
/// 23-24].
enum class SpurRule {
  kKeep,       ///< none: dead ends are judged elsewhere
  kHangsOnIt,  ///< nodes with no neighbour outside the clique
  kDegreeOne,  ///< as written there: degree 1 after the clique's edges were added
};

/// Maximal cliques of more than two nodes, largest first, equal ones by their nodes.
/// Throws Refused if there are more than `limit`: their number grows exponentially with the passes.
[[nodiscard]] std::vector<std::vector<int>> large_cliques(const RoadGraph& graph,
                                                          std::size_t limit);

/// Merges `nodes` into the one of them that is nearest to their mean; returns it. The others lose
/// their edges and stay as isolated nodes.
int contract(RoadGraph& graph, const std::vector<int>& nodes);

/// One pruning loop of algorithm 1 (lines 14-25): cliques of more than two nodes are replaced by
/// their node nearest to the centre. Returns whether there was any.
bool prune_once(RoadGraph& graph, SpurRule spurs, std::size_t clique_limit = 2'000'000);

}  // namespace roadbook
