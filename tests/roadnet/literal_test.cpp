#include <gtest/gtest.h>

#include <limits>

#include "base/error.hpp"
#include "base/random.hpp"
#include "roadnet/paper_algorithms.hpp"
#include "tests/roadnet/random_lots.hpp"

namespace roadbook {
namespace {

// Algorithm 1, lines 1-12, pair by pair as the document writes it.
RoadGraph slow_full_graph(const std::vector<DrivenPass>& passes, double d) {
  RoadGraph graph;
  std::vector<std::size_t> pass_of;
  for (std::size_t p = 0; p < passes.size(); ++p) {
    for (const auto& x : passes[p].positions) {
      graph.add_node(x);
      pass_of.push_back(p);
    }
  }
  const auto at = [&](int i) { return graph.positions[static_cast<std::size_t>(i)]; };
  const auto pass = [&](int i) { return pass_of[static_cast<std::size_t>(i)]; };
  for (int i = 0; i < graph.size(); ++i) {
    for (int j = i + 1; j < graph.size(); ++j) {
      if ((at(i) - at(j)).norm() <= d) graph.add_edge(i, j);
    }
  }
  for (int i = 0; i < graph.size(); ++i) {
    int j = i + 1;
    for (; j < graph.size() && pass(i) == pass(j) && (at(i) - at(j)).norm() <= d; ++j) {
      graph.remove_edge(i, j);
    }
  }
  for (int i = 0; i + 1 < graph.size(); ++i) {
    if (pass(i) == pass(i + 1)) graph.add_edge(i, i + 1);
  }
  return graph;
}

TEST(LiteralRoadNetwork, FullGraphIsTheDocumentsPairByPair) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    std::vector<DrivenPass> passes(2);
    for (DrivenPass& pass : passes) {
      Eigen::Vector3d at(0, 0, 0);
      for (int i = 0; i < 60; ++i) {
        at += Eigen::Vector3d(random.normal(), random.normal(), 0.0);
        pass.positions.push_back(at);
      }
    }
    EXPECT_EQ(literal_full_graph(passes, 2.0).neighbours, slow_full_graph(passes, 2.0).neighbours);
  }
}

TEST(LiteralRoadNetwork, FindsTheLanesOfTheDocumentsKindOfDrive) {
  // One metre between poses, d = 2 m, two laps: the setting in which the batch method is right.
  const test::Lot lot = test::random_lot(0, 3);
  LiteralOptions options;
  options.connecting_distance_m = 2.0;
  options.pruning_loops = 100;
  const auto stages = literal_road_network(test::drive_lot(lot, 2, 0.2, 1.0, 3), options);
  EXPECT_LE(stages.one_loop.size(), stages.full.size());
  EXPECT_LT(stages.finished.size(), stages.full.size());
  EXPECT_TRUE(large_cliques(stages.finished, 1000).empty());
  EXPECT_EQ(component_count(stages.finished), 1);
  std::size_t edges = 0;
  for (const LaneChain& lane : stages.lanes) edges += lane.nodes.size() - 1;
  EXPECT_EQ(edges, edge_count(stages.finished));
}

TEST(LiteralRoadNetwork, RefusesWhenTheCliquesGrowBeyondTheLimit) {
  LiteralOptions options;
  options.clique_limit = 100;
  const auto passes = test::drive_lot(test::random_lot(5, 1), 4, 0.1, 0.2, 1);
  EXPECT_THROW(static_cast<void>(literal_road_network(passes, options)), Refused);
}

TEST(LiteralRoadNetwork, TakesNothingAndSinglePosesAndRefusesNumbersThatAreNone) {
  EXPECT_TRUE(literal_road_network({}).lanes.empty());
  EXPECT_TRUE(literal_road_network({{0, false, {{1, 2, 3}}}}).lanes.empty());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(literal_road_network({{0, false, {{nan, 0, 0}}}})), BadInput);
  LiteralOptions options;
  options.connecting_distance_m = 0.0;
  EXPECT_THROW(static_cast<void>(literal_road_network({}, options)), InvalidOption);
}

TEST(PruneOnce, ReplacesACliqueByItsMemberNearestToTheCentre) {
  RoadGraph graph;
  graph.add_node({0, 0, 0});
  graph.add_node({2, 0, 0});
  graph.add_node({1, 0.5, 0});
  graph.add_node({5, 0, 0});
  graph.add_node({9, 0, 0});
  for (const auto& [a, b] : {std::pair{0, 1}, {0, 2}, {1, 2}, {1, 3}, {3, 4}}) graph.add_edge(a, b);
  EXPECT_TRUE(prune_once(graph, SpurRule::kKeep));
  EXPECT_EQ(graph.origin, (std::vector<int>{2, 3, 4}));
  EXPECT_TRUE(graph.has_edge(0, 1));
  EXPECT_TRUE(graph.has_edge(1, 2));
  EXPECT_FALSE(prune_once(graph, SpurRule::kKeep));
}

}  // namespace
}  // namespace roadbook
