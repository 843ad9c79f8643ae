#pragma once

#include <vector>

#include "roadnet/graph.hpp"

namespace roadbook {

/// A lane as nodes of a graph, in order. A ring repeats its first node at the end.
struct LaneChain {
  std::vector<int> nodes;
  bool closed = false;  ///< a ring without intersection
};

/// Divides the graph into lanes [metric-semantic maps, algorithm 2]. Unlike the paper, it removes
/// edges instead of nodes, and ends lanes at nodes of degree other than 2. So every edge is in
/// exactly one lane, and the lanes do not depend on the order of the nodes. Nodes without edges
/// belong to no lane. Linear.
[[nodiscard]] std::vector<LaneChain> trace_lanes(const RoadGraph& graph);

}  // namespace roadbook
