#include "roadnet/simplify.hpp"

#include <gtest/gtest.h>

namespace roadbook {
namespace {

constexpr double kReach = 3.0;

// Adds `count` nodes, one reach apart, from `from` on; returns the last one.
int add_road(RoadGraph& graph, int from, const Eigen::Vector3d& step, int count) {
  int last = from;
  for (int i = 0; i < count; ++i) {
    const int next = graph.add_node(graph.positions[static_cast<std::size_t>(last)] + step);
    graph.add_edge(last, next);
    last = next;
  }
  return last;
}

// Two crossings 7 m apart, each with two long dead ends. The link between them has one node.
RoadGraph two_crossings() {
  RoadGraph graph;
  const int a = graph.add_node({0, 0, 0});
  const int b = graph.add_node({7, 0, 0});
  const int middle = graph.add_node({3.5, 0, 0});
  graph.add_edge(a, middle);
  graph.add_edge(middle, b);
  for (const double side : {-1.0, 1.0}) {
    add_road(graph, a, {-1.5, 2.5 * side, 0}, 10);
    add_road(graph, b, {1.5, 2.5 * side, 0}, 10);
  }
  return graph;
}

TEST(RemoveSpurs, AShortLinkBetweenTwoCrossingsIsNoSpur) {
  RoadGraph graph = two_crossings();
  const int nodes = graph.size();
  EXPECT_FALSE(remove_spurs(graph, {}, kReach));
  EXPECT_EQ(graph.size(), nodes);
  EXPECT_EQ(component_count(graph), 1);
}

TEST(RemoveSpurs, AShortDeadEndGoesUnlessItLeadsAwayFromTheRest) {
  for (const bool is_driven : {false, true}) {
    RoadGraph graph = two_crossings();
    const int nodes = graph.size();
    // 4 m, shorter than three reaches, across the link.
    const int tip = add_road(graph, 2, {0, 2, 0}, 2);
    std::vector<PassSamples> passes(1);
    if (is_driven)
      passes[0].points = {graph.positions[static_cast<std::size_t>(tip)] +
                          Eigen::Vector3d(0, 1.5, 0)};
    EXPECT_EQ(remove_spurs(graph, passes, kReach), !is_driven);
    EXPECT_EQ(graph.size(), is_driven ? nodes + 2 : nodes);
  }
}

TEST(RemoveShortDeadEnds, KeepsLinksAndLongDeadEnds) {
  RoadGraph graph = two_crossings();
  const int nodes = graph.size();
  EXPECT_FALSE(remove_short_dead_ends(graph, 20.0));  // the dead ends are 29 m long
  add_road(graph, 2, {0, 2, 0}, 2);
  EXPECT_TRUE(remove_short_dead_ends(graph, 20.0));
  EXPECT_EQ(graph.size(), nodes);
}

}  // namespace
}  // namespace roadbook
