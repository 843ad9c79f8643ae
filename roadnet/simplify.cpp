#include "roadnet/simplify.hpp"

#include <algorithm>
#include <map>

#include "base/geometry/outline.hpp"
#include "roadnet/prune.hpp"
#include "roadnet/spatial_hash.hpp"
#include "roadnet/trace_lanes.hpp"

namespace roadbook {
namespace {

constexpr int kMaxHops = 5;  // more nodes than that do not fit into a compact loop

// Loops and gaps below these many reaches are scatter, not roads: a cover node stands for all
// within one reach, so two of them tell places apart only at two reaches.
constexpr double kCompactLoop = 2.5;
constexpr double kCloseIntersections = 2.0;
constexpr double kShortSpur = 3.0;

// Fewest-hop way from a to b that does not use the edge a-b; empty: none within kMaxHops.
std::vector<int> way_round(const RoadGraph& graph, int a, int b) {
  std::map<int, int> from{{a, a}};
  std::vector<int> front{a};
  for (int hop = 0; hop < kMaxHops && !front.empty(); ++hop) {
    std::vector<int> next;
    for (const int node : front) {
      for (const int other : graph.neighbours[static_cast<std::size_t>(node)]) {
        if ((node == a && other == b) || !from.emplace(other, node).second) continue;
        if (other != b) {
          next.push_back(other);
          continue;
        }
        std::vector<int> way{b};
        while (way.back() != a) way.push_back(from.at(way.back()));
        return way;
      }
    }
    front = std::move(next);
  }
  return {};
}

double diameter(const RoadGraph& graph, const std::vector<int>& nodes) {
  double largest = 0.0;
  for (const int a : nodes) {
    for (const int b : nodes) {
      largest = std::max(largest, (graph.positions[static_cast<std::size_t>(a)] -
                                   graph.positions[static_cast<std::size_t>(b)])
                                      .norm());
    }
  }
  return largest;
}

bool contract_compact_loops(RoadGraph& graph, double max_diameter_m) {
  bool any = false;
  for (int a = 0; a < graph.size(); ++a) {
    for (std::size_t k = 0; k < graph.degree(a); ++k) {
      const int b = graph.neighbours[static_cast<std::size_t>(a)][k];
      const std::vector<int> loop = way_round(graph, a, b);
      if (loop.empty() || diameter(graph, loop) > max_diameter_m) continue;
      contract(graph, loop);
      any = true;
      break;
    }
  }
  return any;
}

double chain_length(const RoadGraph& graph, const LaneChain& lane) {
  double length = 0.0;
  for (std::size_t i = 0; i + 1 < lane.nodes.size(); ++i) {
    length += (graph.positions[static_cast<std::size_t>(lane.nodes[i + 1])] -
               graph.positions[static_cast<std::size_t>(lane.nodes[i])])
                  .norm();
  }
  return length;
}

// The shortest lane between two intersections, if it is short enough: one crossing seen as two.
bool merge_closest_intersections(RoadGraph& graph, double limit_m) {
  double shortest = limit_m;
  std::vector<int> nodes;
  for (const LaneChain& lane : trace_lanes(graph)) {
    const int from = lane.nodes.front();
    const int to = lane.nodes.back();
    if (from == to || graph.degree(from) < 3 || graph.degree(to) < 3) continue;
    const double length = chain_length(graph, lane);
    if (length >= shortest) continue;
    shortest = length;
    nodes = lane.nodes;
  }
  if (!nodes.empty()) contract(graph, nodes);
  return !nodes.empty();
}

// Whether `p` is within reach of an edge that does not touch a flagged node.
bool covered_without(const RoadGraph& graph,
                     const SpatialHash& nodes,
                     const std::vector<bool>& flags,
                     const Eigen::Vector3d& p,
                     double reach_m) {
  bool covered = false;
  nodes.visit_near(p, 4.0 * reach_m, [&](int a, double) {
    if (covered || flags[static_cast<std::size_t>(a)]) return;
    const auto& list = graph.neighbours[static_cast<std::size_t>(a)];
    covered = std::any_of(list.begin(), list.end(), [&](int b) {
      return !flags[static_cast<std::size_t>(b)] &&
             distance_to_segment(p, graph.positions[static_cast<std::size_t>(a)],
                                 graph.positions[static_cast<std::size_t>(b)]) <= reach_m;
    });
  });
  return covered;
}

}  // namespace

void remove_isolated(RoadGraph& graph) {
  std::vector<bool> flags;
  for (const auto& list : graph.neighbours) flags.push_back(list.empty());
  graph.remove_nodes(flags);
}

bool remove_spurs(RoadGraph& graph, const std::vector<PassSamples>& passes, double reach_m) {
  SpatialHash nodes(4.0 * reach_m);
  for (const Eigen::Vector3d& position : graph.positions) nodes.insert(position);
  std::vector<std::vector<Eigen::Vector3d>> samples(graph.positions.size());
  for (const PassSamples& pass : passes) {
    for (const Eigen::Vector3d& point : pass.points) {
      const int node = nodes.nearest(point, 4.0 * reach_m);
      if (node >= 0) samples[static_cast<std::size_t>(node)].push_back(point);
    }
  }

  std::vector<bool> flags(graph.positions.size(), false);
  bool any = false;
  for (const LaneChain& lane : trace_lanes(graph)) {
    const bool tail_first = graph.degree(lane.nodes.front()) == 1;
    const int root = tail_first ? lane.nodes.back() : lane.nodes.front();
    const int tip = tail_first ? lane.nodes.front() : lane.nodes.back();
    if (graph.degree(tip) != 1 || graph.degree(root) < 3) continue;
    if (chain_length(graph, lane) > kShortSpur * reach_m) continue;
    std::vector<int> spur;
    for (const int node : lane.nodes) {
      if (node == root) continue;
      spur.push_back(node);
      flags[static_cast<std::size_t>(node)] = true;
    }
    const bool needless = std::all_of(spur.begin(), spur.end(), [&](int node) {
      const auto& own = samples[static_cast<std::size_t>(node)];
      return std::all_of(own.begin(), own.end(), [&](const Eigen::Vector3d& p) {
        return covered_without(graph, nodes, flags, p, reach_m);
      });
    });
    any = any || needless;
    if (needless) continue;
    for (const int node : spur) flags[static_cast<std::size_t>(node)] = false;
  }
  if (any) graph.remove_nodes(flags);
  return any;
}

bool remove_short_dead_ends(RoadGraph& graph, double min_length_m) {
  std::vector<bool> flags(graph.positions.size(), false);
  bool any = false;
  for (const LaneChain& lane : trace_lanes(graph)) {
    const std::size_t from = graph.degree(lane.nodes.front());
    const std::size_t to = graph.degree(lane.nodes.back());
    if ((from != 1 && to != 1) || chain_length(graph, lane) >= min_length_m) continue;
    any = true;
    for (const int node : lane.nodes)
      if (graph.degree(node) < 3) flags[static_cast<std::size_t>(node)] = true;
  }
  if (any) graph.remove_nodes(flags);
  if (any) remove_isolated(graph);
  return any;
}

void simplify(RoadGraph& graph, const std::vector<PassSamples>& passes, double reach_m) {
  bool changed = true;
  while (changed) {  // every change removes a node, so this ends
    while (prune_once(graph, SpurRule::kKeep)) {
    }
    changed = contract_compact_loops(graph, kCompactLoop * reach_m) ||
              merge_closest_intersections(graph, kCloseIntersections * reach_m);
    remove_isolated(graph);
    if (!changed) changed = remove_spurs(graph, passes, reach_m);
  }
}

}  // namespace roadbook
