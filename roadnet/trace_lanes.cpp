#include "roadnet/trace_lanes.hpp"

namespace roadbook {
namespace {

// Follows the edge start-next to the next terminal, or back to the start of a ring, and takes the
// edges on the way out of the graph. `degree` is that of the whole graph.
LaneChain follow(RoadGraph& rest, const std::vector<std::size_t>& degree, int start, int next) {
  LaneChain lane;
  lane.nodes = {start, next};
  rest.remove_edge(start, next);
  while (degree[static_cast<std::size_t>(next)] == 2 && next != start) {
    const int onward = rest.neighbours[static_cast<std::size_t>(next)].front();
    rest.remove_edge(next, onward);
    next = onward;
    lane.nodes.push_back(next);
  }
  lane.closed = degree[static_cast<std::size_t>(start)] == 2;
  return lane;
}

}  // namespace

std::vector<LaneChain> trace_lanes(const RoadGraph& graph) {
  RoadGraph rest = graph;
  std::vector<std::size_t> degree;
  degree.reserve(graph.neighbours.size());
  for (const auto& list : graph.neighbours) degree.push_back(list.size());

  std::vector<LaneChain> lanes;
  // Terminals first; what is left then are rings, which may start anywhere.
  for (const bool rings : {false, true}) {
    for (int node = 0; node < graph.size(); ++node) {
      if (!rings && degree[static_cast<std::size_t>(node)] == 2) continue;
      const auto& open = rest.neighbours[static_cast<std::size_t>(node)];
      while (!open.empty()) lanes.push_back(follow(rest, degree, node, open.front()));
    }
  }
  return lanes;
}

}  // namespace roadbook
