#include "speedmap/presence/presence_graph.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.hpp"

namespace roadbook {

const char* to_text(PlaceClass place) {
  switch (place) {
    case PlaceClass::kCrossing:
      return "crossing";
    case PlaceClass::kSpace:
      return "space";
    case PlaceClass::kLane:
      return "lane";
    case PlaceClass::kOther:
      break;
  }
  return "other";
}

void PresenceGraph::check() const {
  if (nodes.empty()) throw InvalidOption("nodes", "none", "at least one");
  for (const PresenceNode& node : nodes) {
    if (!(node.prior >= 0.0 && node.prior <= 1.0))
      throw InvalidOption("prior", std::to_string(node.prior), "0 to 1");
    if (!(std::isfinite(node.weight) && node.weight > 0.0))
      throw InvalidOption("weight", std::to_string(node.weight), "a number above 0");
  }
  const auto count = static_cast<int>(nodes.size());
  std::vector<std::pair<int, int>> pairs;
  pairs.reserve(edges.size());
  for (const PresenceEdge& edge : edges) {
    for (const int end : {edge.a, edge.b})
      if (end < 0 || end >= count)
        throw InvalidOption("edge", std::to_string(end),
                            "a node, 0 to " + std::to_string(count - 1));
    if (edge.a == edge.b) throw InvalidOption("edge", "a node with itself", "two nodes");
    if (!(std::isfinite(edge.weight) && edge.weight >= 0.0))
      throw InvalidOption("edge weight", std::to_string(edge.weight), "0 or more");
    pairs.emplace_back(std::min(edge.a, edge.b), std::max(edge.a, edge.b));
  }
  std::sort(pairs.begin(), pairs.end());
  const auto twice = std::adjacent_find(pairs.begin(), pairs.end());
  if (twice != pairs.end())
    throw InvalidOption(
        "edge", std::to_string(twice->first) + "-" + std::to_string(twice->second) + " twice",
        "every edge once");
}

}  // namespace roadbook
