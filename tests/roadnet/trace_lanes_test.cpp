#include "roadnet/trace_lanes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <string>

#include "base/random.hpp"

namespace roadbook {
namespace {

using Edges = std::vector<std::pair<int, int>>;

RoadGraph graph_of(int nodes, const Edges& edges) {
  RoadGraph graph;
  for (int i = 0; i < nodes; ++i) graph.add_node({1.0 * i, 0.0, 0.0});
  for (const auto& [a, b] : edges) graph.add_edge(a, b);
  return graph;
}

// Each lane as the set of its edges: what must not depend on names and order.
std::multiset<std::set<std::pair<int, int>>> lane_sets(const std::vector<LaneChain>& lanes,
                                                       const std::vector<int>& name) {
  std::multiset<std::set<std::pair<int, int>>> sets;
  for (const LaneChain& lane : lanes) {
    std::set<std::pair<int, int>> edges;
    for (std::size_t i = 0; i + 1 < lane.nodes.size(); ++i) {
      const int a = name[static_cast<std::size_t>(lane.nodes[i])];
      const int b = name[static_cast<std::size_t>(lane.nodes[i + 1])];
      edges.emplace(std::min(a, b), std::max(a, b));
    }
    sets.insert(edges);
  }
  return sets;
}

std::vector<int> own_names(const RoadGraph& graph) {
  std::vector<int> names(graph.positions.size());
  std::iota(names.begin(), names.end(), 0);
  return names;
}

void expect_partition(const RoadGraph& graph, const std::vector<LaneChain>& lanes) {
  std::size_t edges = 0;
  std::set<std::pair<int, int>> seen;
  for (const LaneChain& lane : lanes) {
    for (std::size_t i = 0; i + 1 < lane.nodes.size(); ++i) {
      const int a = lane.nodes[i];
      const int b = lane.nodes[i + 1];
      ASSERT_TRUE(graph.has_edge(a, b));
      seen.emplace(std::min(a, b), std::max(a, b));
      ++edges;
    }
  }
  EXPECT_EQ(edges, edge_count(graph));
  EXPECT_EQ(seen.size(), edges) << "an edge is in two lanes";
}

// Cycle rank of the lanes as edges between their ends; a ring is one loop.
int rank_of_lanes(const RoadGraph& graph, const std::vector<LaneChain>& lanes) {
  std::vector<int> root = own_names(graph);
  const auto find = [&](int node) {
    while (root[static_cast<std::size_t>(node)] != node)
      node = root[static_cast<std::size_t>(node)];
    return node;
  };
  int rank = 0;
  for (const LaneChain& lane : lanes) {
    const int a = find(lane.nodes.front());
    const int b = find(lane.nodes.back());
    if (a == b) ++rank;
    root[static_cast<std::size_t>(a)] = b;
  }
  return rank;
}

struct Case {
  std::string name;
  int nodes;
  Edges edges;
  std::size_t lanes;
  std::size_t rings;
};

TEST(TraceLanes, FindsTheLanesOfSmallGraphsWorkedByHand) {
  Edges grid;
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 3; ++x) {
      if (x < 2) grid.emplace_back(3 * y + x, 3 * y + x + 1);
      if (y < 2) grid.emplace_back(3 * y + x, 3 * y + x + 3);
    }
  }
  const std::vector<Case> cases{
      {"K4", 4, {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}, 6, 0},
      {"theta", 4, {{0, 1}, {0, 2}, {2, 1}, {0, 3}, {3, 1}}, 3, 0},
      {"H", 6, {{0, 1}, {0, 2}, {0, 3}, {1, 4}, {1, 5}}, 5, 0},
      {"lollipop", 5, {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 1}}, 2, 0},
      {"figure 8", 7, {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {4, 5}, {5, 6}, {6, 0}}, 2, 0},
      {"ring", 5, {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 0}}, 1, 1},
      {"grid", 9, grid, 8, 0},
      {"isolated", 3, {}, 0, 0},
      {"crossing", 5, {{0, 1}, {0, 2}, {0, 3}, {0, 4}}, 4, 0},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const RoadGraph graph = graph_of(c.nodes, c.edges);
    const auto lanes = trace_lanes(graph);
    EXPECT_EQ(lanes.size(), c.lanes);
    EXPECT_EQ(std::count_if(lanes.begin(), lanes.end(), [](const auto& l) { return l.closed; }),
              static_cast<std::ptrdiff_t>(c.rings));
    for (const LaneChain& lane : lanes) {
      if (lane.closed) {
        EXPECT_EQ(lane.nodes.front(), lane.nodes.back());
      }
    }
    expect_partition(graph, lanes);
  }
}

TEST(TraceLanes, PartitionsEdgesKeepsLoopsAndIgnoresNamesOn10000RandomGraphs) {
  for (std::uint64_t seed = 0; seed < 10'000; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed, "trace lanes");
    const int nodes = 1 + static_cast<int>(random.below(24));
    Edges edges;
    const std::uint64_t count = random.below(static_cast<std::uint64_t>(2 * nodes));
    for (std::uint64_t i = 0; i < count; ++i) {
      edges.emplace_back(static_cast<int>(random.below(static_cast<std::uint64_t>(nodes))),
                         static_cast<int>(random.below(static_cast<std::uint64_t>(nodes))));
    }
    const RoadGraph graph = graph_of(nodes, edges);
    const auto lanes = trace_lanes(graph);
    expect_partition(graph, lanes);
    EXPECT_EQ(rank_of_lanes(graph, lanes), cycle_rank(graph));

    std::vector<int> name = own_names(graph);
    for (std::size_t i = name.size(); i > 1; --i) std::swap(name[i - 1], name[random.below(i)]);
    std::vector<int> back(name.size());
    for (std::size_t i = 0; i < name.size(); ++i) {
      back[static_cast<std::size_t>(name[i])] = static_cast<int>(i);
    }
    for (auto& [a, b] : edges) {
      a = name[static_cast<std::size_t>(a)];
      b = name[static_cast<std::size_t>(b)];
    }
    EXPECT_EQ(lane_sets(trace_lanes(graph_of(nodes, edges)), back),
              lane_sets(lanes, own_names(graph)));
    if (HasFailure()) return;
  }
}

}  // namespace
}  // namespace roadbook
