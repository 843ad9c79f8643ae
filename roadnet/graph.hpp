#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace roadbook {

/// An undirected graph of positions, without self-loops or double edges.
struct RoadGraph {
  std::vector<Eigen::Vector3d> positions;    ///< [m]
  std::vector<std::vector<int>> neighbours;  ///< ascending, symmetric
  std::vector<int> origin;                   ///< index of the node before any node was removed

  [[nodiscard]] int size() const { return static_cast<int>(positions.size()); }
  [[nodiscard]] std::size_t degree(int node) const {
    return neighbours[static_cast<std::size_t>(node)].size();
  }
  [[nodiscard]] bool has_edge(int a, int b) const;

  /// Adds a node and returns its index, which is also its `origin`.
  int add_node(const Eigen::Vector3d& position);
  /// Does nothing if the edge exists or a == b.
  void add_edge(int a, int b);
  void remove_edge(int a, int b);
  /// Removes all edges of a node; the node stays.
  void isolate(int node);
  /// Removes the nodes whose flag is set, with their edges; the others keep their order.
  void remove_nodes(const std::vector<bool>& flags);
};

[[nodiscard]] std::size_t edge_count(const RoadGraph& graph);
/// Connected parts; a node without edges counts as one part.
[[nodiscard]] int component_count(const RoadGraph& graph);
/// Number of independent loops: edges - nodes + components.
[[nodiscard]] int cycle_rank(const RoadGraph& graph);

}  // namespace roadbook
