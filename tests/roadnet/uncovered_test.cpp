#include "roadnet/uncovered.hpp"

#include <gtest/gtest.h>

#include "roadnet/build_network.hpp"

namespace roadbook {
namespace {

DrivenPass straight_along_x(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  DrivenPass pass;
  const int pieces = static_cast<int>((b - a).norm() / 0.2);
  for (int k = 0; k <= pieces; ++k) pass.positions.emplace_back(a + (b - a) * k / pieces);
  return pass;
}

// The side road of 60 m leaves the reach of 3 m around the main road after 3 m.
TEST(Uncovered, NamesTheRoadThatIsLeftOutAndHowMuchWasDrivenThere) {
  std::vector<DrivenPass> passes(3, straight_along_x({0, 0, 0}, {100, 0, 0}));
  passes.push_back(straight_along_x({50, 0, 0}, {50, 60, 0}));
  passes.push_back(straight_along_x({20, 0, 0}, {20, -10, 0}));
  RoadNetworkOptions options;
  options.min_passes = 2;
  const RoadNetwork network = build_road_network(passes, options);
  ASSERT_EQ(network.uncovered.size(), 2U);
  const UncoveredStretch& most = network.uncovered[0];
  EXPECT_NEAR(most.from.y(), 3.0, 2.0);
  EXPECT_NEAR((most.to - Eigen::Vector3d(50, 60, 0)).norm(), 0.0, 0.1);
  EXPECT_NEAR(most.driven_m, 57.0, 3.0);
  EXPECT_EQ(most.parts, 1);
  EXPECT_NEAR(network.uncovered[1].to.y(), -10.0, 0.1);
}

TEST(Uncovered, PartsOfSeveralPassesAreOneStretch) {
  RoadNetwork network;
  network.reach_m = 3.0;
  network.lanes.push_back({});
  network.lanes[0].centre = {{0, 0, 0}, {100, 0, 0}};
  const auto all = uncovered_stretches(
      network,
      {straight_along_x({50, 0, 0}, {50, 40, 0}), straight_along_x({51, 60, 0}, {51, 0, 0}),
       straight_along_x({0, 0, 3}, {100, 0, 3})},  // the floor above
      1.5);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_NEAR(all[0].driven_m, 100.0, 3.0);
  EXPECT_NEAR(all[0].from.z(), 3.0, 1e-9);
  EXPECT_NEAR(all[1].driven_m, 37.0 + 57.0, 4.0);
  EXPECT_EQ(all[1].parts, 2);
}

TEST(Uncovered, IsEmptyWhereEverythingIsOnTheNetwork) {
  const RoadNetwork network = build_road_network({straight_along_x({0, 0, 0}, {100, 0, 0})});
  EXPECT_GE(network.coverage, 0.99);
  EXPECT_TRUE(network.uncovered.empty());
}

}  // namespace
}  // namespace roadbook
