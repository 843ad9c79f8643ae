#include "roadnet/prune.hpp"

#include <algorithm>
#include <boost/graph/adjacency_matrix.hpp>
#include <boost/graph/bron_kerbosch_all_cliques.hpp>
#include <string>

#include "base/error.hpp"

namespace roadbook {
namespace {

using Adjacency = boost::adjacency_matrix<boost::undirectedS>;

struct CliqueCollector {
  const std::vector<int>* names;
  std::vector<std::vector<int>>* found;
  std::size_t limit;

  template <typename Clique, typename Graph>
  void clique(const Clique& nodes, const Graph&) {
    if (found->size() >= limit) {
      throw Refused("road network: more than " + std::to_string(limit) +
                    " cliques; use the default mode, or a smaller connecting distance");
    }
    std::vector<int> members;
    for (const auto node : nodes) members.push_back((*names)[node]);
    std::sort(members.begin(), members.end());
    found->push_back(std::move(members));
  }
};

bool share_a_neighbour(const RoadGraph& graph, int a, int b) {
  const auto& list = graph.neighbours[static_cast<std::size_t>(a)];
  return std::any_of(list.begin(), list.end(), [&](int c) { return graph.has_edge(c, b); });
}

// The edges that are sides of triangles. A clique of three or more consists of such edges only, so
// the search may run on each connected part of them alone: that keeps its matrices small.
RoadGraph triangle_sides(const RoadGraph& graph) {
  RoadGraph sides;
  sides.positions = graph.positions;
  sides.neighbours.resize(graph.neighbours.size());
  for (int a = 0; a < graph.size(); ++a) {
    for (const int b : graph.neighbours[static_cast<std::size_t>(a)]) {
      if (share_a_neighbour(graph, a, b)) {
        sides.neighbours[static_cast<std::size_t>(a)].push_back(b);
      }
    }
  }
  return sides;
}

std::vector<int> part_of(const RoadGraph& graph, int start, std::vector<int>& place) {
  std::vector<int> part{start};
  place[static_cast<std::size_t>(start)] = 0;
  for (std::size_t i = 0; i < part.size(); ++i) {
    for (const int other : graph.neighbours[static_cast<std::size_t>(part[i])]) {
      if (place[static_cast<std::size_t>(other)] >= 0) continue;
      place[static_cast<std::size_t>(other)] = static_cast<int>(part.size());
      part.push_back(other);
    }
  }
  return part;
}

std::vector<int> outer_neighbours(const RoadGraph& graph, const std::vector<int>& nodes) {
  std::vector<int> outer;
  for (const int node : nodes) {
    for (const int other : graph.neighbours[static_cast<std::size_t>(node)]) {
      if (std::find(nodes.begin(), nodes.end(), other) == nodes.end()) outer.push_back(other);
    }
  }
  std::sort(outer.begin(), outer.end());
  outer.erase(std::unique(outer.begin(), outer.end()), outer.end());
  return outer;
}

int nearest_to_mean(const RoadGraph& graph, const std::vector<int>& nodes) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const int node : nodes) mean += graph.positions[static_cast<std::size_t>(node)];
  mean /= static_cast<double>(nodes.size());
  return *std::min_element(nodes.begin(), nodes.end(), [&](int a, int b) {
    return (graph.positions[static_cast<std::size_t>(a)] - mean).squaredNorm() <
           (graph.positions[static_cast<std::size_t>(b)] - mean).squaredNorm();
  });
}

bool is_spur(
    const RoadGraph& graph, const std::vector<int>& clique, int centre, int node, SpurRule rule) {
  const auto& list = graph.neighbours[static_cast<std::size_t>(node)];
  if (rule == SpurRule::kDegreeOne) return list.size() == 1;
  if (rule == SpurRule::kKeep) return false;
  return std::all_of(list.begin(), list.end(), [&](int other) {
    return other == centre || std::find(clique.begin(), clique.end(), other) != clique.end();
  });
}

}  // namespace

std::vector<std::vector<int>> large_cliques(const RoadGraph& graph, std::size_t limit) {
  const RoadGraph sides = triangle_sides(graph);
  std::vector<std::vector<int>> found;
  std::vector<int> place(graph.positions.size(), -1);
  for (int start = 0; start < graph.size(); ++start) {
    if (place[static_cast<std::size_t>(start)] >= 0 || sides.degree(start) == 0) continue;
    const std::vector<int> part = part_of(sides, start, place);
    Adjacency matrix(part.size());
    for (const int a : part) {
      for (const int b : sides.neighbours[static_cast<std::size_t>(a)]) {
        if (a < b) {
          boost::add_edge(static_cast<std::size_t>(place[static_cast<std::size_t>(a)]),
                          static_cast<std::size_t>(place[static_cast<std::size_t>(b)]), matrix);
        }
      }
    }
    boost::bron_kerbosch_all_cliques(matrix, CliqueCollector{&part, &found, limit}, 3);
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
    return a.size() != b.size() ? a.size() > b.size() : a < b;
  });
  return found;
}

int contract(RoadGraph& graph, const std::vector<int>& nodes) {
  const int centre = nearest_to_mean(graph, nodes);
  const std::vector<int> outer = outer_neighbours(graph, nodes);
  for (const int node : nodes) graph.isolate(node);
  for (const int other : outer) graph.add_edge(centre, other);
  return centre;
}

bool prune_once(RoadGraph& graph, SpurRule spurs, std::size_t clique_limit) {
  const auto cliques = large_cliques(graph, clique_limit);
  std::vector<bool> removed(graph.positions.size(), false);
  const auto is_removed = [&](int node) { return removed[static_cast<std::size_t>(node)]; };
  for (const auto& clique : cliques) {
    const std::vector<int> outer = outer_neighbours(graph, clique);
    if (std::any_of(clique.begin(), clique.end(), is_removed) ||
        std::any_of(outer.begin(), outer.end(), is_removed)) {
      continue;
    }
    const int centre = nearest_to_mean(graph, clique);
    for (const int node : outer) graph.add_edge(centre, node);
    for (const int node : outer) {
      if (is_spur(graph, clique, centre, node, spurs))
        removed[static_cast<std::size_t>(node)] = true;
    }
    for (const int node : clique) removed[static_cast<std::size_t>(node)] = node != centre;
  }
  if (!cliques.empty()) graph.remove_nodes(removed);
  return !cliques.empty();
}

}  // namespace roadbook
