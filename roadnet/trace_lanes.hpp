#pragma once

#include <vector>

#include "roadnet/graph.hpp"

namespace roadbook {

/// A lane as nodes of a graph, in order. A ring repeats its first node at the end.
struct LaneChain {
  std::vector<int> nodes;
  bool closed = false;  ///< a ring without intersection
};

/// Algorithm 2 of [metric-semantic maps], with edges instead of nodes removed and the terminals
/// fixed beforehand (nodes of degree other than 2): every edge is in exactly one lane, and the
/// lanes do not depend on the order of visits. Nodes without edges belong to no lane. Linear.
[[nodiscard]] std::vector<LaneChain> trace_lanes(const RoadGraph& graph);

}  // namespace roadbook
