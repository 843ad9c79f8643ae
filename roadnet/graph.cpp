#include "roadnet/graph.hpp"

#include <algorithm>

namespace roadbook {
namespace {

void insert_sorted(std::vector<int>& list, int value) {
  const auto at = std::lower_bound(list.begin(), list.end(), value);
  if (at == list.end() || *at != value) list.insert(at, value);
}

void erase_sorted(std::vector<int>& list, int value) {
  const auto at = std::lower_bound(list.begin(), list.end(), value);
  if (at != list.end() && *at == value) list.erase(at);
}

}  // namespace

bool RoadGraph::has_edge(int a, int b) const {
  const auto& list = neighbours[static_cast<std::size_t>(a)];
  return std::binary_search(list.begin(), list.end(), b);
}

int RoadGraph::add_node(const Eigen::Vector3d& position) {
  origin.push_back(size());
  positions.push_back(position);
  neighbours.emplace_back();
  return size() - 1;
}

void RoadGraph::add_edge(int a, int b) {
  if (a == b) return;
  insert_sorted(neighbours[static_cast<std::size_t>(a)], b);
  insert_sorted(neighbours[static_cast<std::size_t>(b)], a);
}

void RoadGraph::remove_edge(int a, int b) {
  erase_sorted(neighbours[static_cast<std::size_t>(a)], b);
  erase_sorted(neighbours[static_cast<std::size_t>(b)], a);
}

void RoadGraph::isolate(int node) {
  auto& own = neighbours[static_cast<std::size_t>(node)];
  for (const int other : own) erase_sorted(neighbours[static_cast<std::size_t>(other)], node);
  own.clear();
}

void RoadGraph::remove_nodes(const std::vector<bool>& flags) {
  std::vector<int> place(positions.size(), -1);
  RoadGraph kept;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (flags[i]) continue;
    place[i] = kept.add_node(positions[i]);
    kept.origin.back() = origin[i];
  }
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (place[i] < 0) continue;
    // Places ascend with the index, so the lists stay sorted.
    for (const int other : neighbours[i]) {
      const int to = place[static_cast<std::size_t>(other)];
      if (to >= 0) kept.neighbours[static_cast<std::size_t>(place[i])].push_back(to);
    }
  }
  *this = std::move(kept);
}

std::size_t edge_count(const RoadGraph& graph) {
  std::size_t ends = 0;
  for (const auto& list : graph.neighbours) ends += list.size();
  return ends / 2;
}

int component_count(const RoadGraph& graph) {
  std::vector<bool> seen(graph.positions.size(), false);
  std::vector<int> open;
  int count = 0;
  for (int start = 0; start < graph.size(); ++start) {
    if (seen[static_cast<std::size_t>(start)]) continue;
    ++count;
    seen[static_cast<std::size_t>(start)] = true;
    open.push_back(start);
    while (!open.empty()) {
      const int node = open.back();
      open.pop_back();
      for (const int other : graph.neighbours[static_cast<std::size_t>(node)]) {
        if (seen[static_cast<std::size_t>(other)]) continue;
        seen[static_cast<std::size_t>(other)] = true;
        open.push_back(other);
      }
    }
  }
  return count;
}

int cycle_rank(const RoadGraph& graph) {
  return static_cast<int>(edge_count(graph)) - graph.size() + component_count(graph);
}

}  // namespace roadbook
