#include "roadnet/lane_samples.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace roadbook {
namespace {

Lane straight_lane(double y, int from_intersection = -1, int to_intersection = -1) {
  Lane lane;
  lane.centre = {{0, y, 0}, {25, y, 0}, {60, y, 0}};
  lane.length_m = 60.0;
  lane.from_intersection = from_intersection;
  lane.to_intersection = to_intersection;
  return lane;
}

DrivenPass along_x(double y) {
  DrivenPass pass;
  for (int i = 0; i <= 120; ++i) pass.positions.emplace_back(0.5 * i, y, 0.0);
  return pass;
}

// Both lanes are within reach of both passes: the nearer one counts, in whatever order the lanes
// stand.
TEST(SamplesByLane, APositionBelongsToTheNearestOfTwoLanes) {
  for (const bool swapped : {false, true}) {
    RoadNetwork network;
    network.lanes = {straight_lane(swapped ? 3.0 : 0.0), straight_lane(swapped ? 0.0 : 3.0)};
    const auto samples = samples_by_lane(network, {along_x(1.2), along_x(2.4)}, 0.5, 4.0, 0.0);
    ASSERT_EQ(samples.size(), 2U);
    const LaneSamples& low = samples[swapped ? 1 : 0];
    const LaneSamples& high = samples[swapped ? 0 : 1];
    EXPECT_EQ(low.points.size(), 121U);
    EXPECT_EQ(high.points.size(), 121U);
    for (const Eigen::Vector3d& p : low.points) EXPECT_NEAR(p.y(), 1.2, 1e-9);
    for (const Eigen::Vector3d& p : high.points) EXPECT_NEAR(p.y(), 2.4, 1e-9);
    for (std::size_t i = 0; i < low.points.size(); ++i)
      EXPECT_NEAR(low.share[i], low.points[i].x() / 60.0, 1e-9);
  }
}

TEST(SamplesByLane, PositionsNearAnIntersectionAndOutOfReachAreLeftOut) {
  RoadNetwork network;
  network.lanes = {straight_lane(0.0, 0, -1)};
  const auto samples = samples_by_lane(network, {along_x(1.0), along_x(5.0)}, 0.5, 4.0, 10.0);
  ASSERT_FALSE(samples[0].points.empty());
  for (const Eigen::Vector3d& p : samples[0].points) {
    EXPECT_GE(p.x(), 10.0 - 1e-9);
    EXPECT_NEAR(p.y(), 1.0, 1e-9);
  }
  // The other end is a dead end, where nobody turns.
  EXPECT_NEAR(samples[0].points.back().x(), 60.0, 1e-9);
  EXPECT_EQ(samples[0].points.size(), 101U);
}

// On another floor, however near from above.
TEST(SamplesByLane, APositionOnAnotherFloorBelongsToNoLane) {
  RoadNetwork network;
  network.lanes = {straight_lane(0.0)};
  DrivenPass above = along_x(0.0);
  for (Eigen::Vector3d& p : above.positions) p.z() = 3.0;
  EXPECT_TRUE(samples_by_lane(network, {above}, 0.5, 4.0, 0.0)[0].points.empty());
}

}  // namespace
}  // namespace roadbook
