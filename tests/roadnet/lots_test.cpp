#include <gtest/gtest.h>

#include <ctime>

#include "base/random.hpp"
#include "roadnet/build_network.hpp"
#include "tests/roadnet/random_lots.hpp"

namespace roadbook::test {
namespace {

int dead_end_count(const RoadNetwork& network) {
  int count = 0;
  for (const Lane& lane : network.lanes) {
    if (lane.closed) continue;
    count += (lane.from_intersection < 0 ? 1 : 0) + (lane.to_intersection < 0 ? 1 : 0);
  }
  return count;
}

bool right_topology(const RoadNetwork& network, const Lot& lot) {
  // The number of dead ends follows: the ends of the lanes are the ends at intersections and those.
  return static_cast<int>(network.intersections.size()) == lot.intersections &&
         static_cast<int>(network.lanes.size()) == lot.lanes &&
         network.cycle_rank == lot.cycle_rank && network.components == 1;
}

TEST(RandomLots, HaveTheRightTopologyInAtLeast95Of100) {
  int right = 0;
  std::string wrong;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Random random(seed, "lots test");
    const Lot lot = random_lot(static_cast<int>(seed) % kLotShapes, seed);
    const int laps = 1 + static_cast<int>(random.below(8));
    const double scatter = random.uniform(0.1, 0.6);
    const RoadNetwork network = build_road_network(drive_lot(lot, laps, scatter, 0.2, seed));
    EXPECT_EQ(network.status, RoadNetworkStatus::kOk) << "seed " << seed;
    EXPECT_GE(network.coverage, 0.99) << "seed " << seed;
    if (right_topology(network, lot)) {
      ++right;
      continue;
    }
    wrong += "seed " + std::to_string(seed) + " " + lot.name + ", laps " + std::to_string(laps) +
             ", scatter " + std::to_string(scatter) + ", reach " + std::to_string(network.reach_m) +
             ": " + std::to_string(network.intersections.size()) + " intersections, " +
             std::to_string(network.lanes.size()) + " lanes, rank " +
             std::to_string(network.cycle_rank) + ", dead ends " +
             std::to_string(dead_end_count(network)) + "\n";
  }
  EXPECT_GE(right, 95) << wrong;
  RecordProperty("right", right);
}

TEST(RandomLots, EightLapsOfPosesEvery20CentimetresTakeLessThanASecond) {
  const Lot lot = random_lot(3, 1);
  const auto passes = drive_lot(lot, 8, 0.3, 0.2, 1);
  const std::clock_t begin = std::clock();  // processor time: other programs do not count
  const RoadNetwork network = build_road_network(passes);
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  EXPECT_TRUE(right_topology(network, lot));
  EXPECT_LT(seconds, 1.0);
}

TEST(RandomLots, CentresOfStraightLanesLieWithin20CentimetresOfTheRoad) {
  Lot lot;
  lot.places = {{0, 0, 0}, {100, 0, 0}};
  lot.roads = {{0, 1}};
  std::vector<DrivenPass> passes;
  Random random(5);
  // The mean of 16 offsets of 0.2 m has a standard deviation of 5 cm: four of them are 20 cm.
  for (int pass = 0; pass < 16; ++pass) {
    DrivenPass drive;
    const double offset = random.normal(0.0, 0.2);
    for (int i = 0; i <= 500; ++i) drive.positions.emplace_back(0.2 * i, offset, 0.0);
    passes.push_back(drive);
  }
  const RoadNetwork network = build_road_network(passes);
  ASSERT_EQ(network.lanes.size(), 1U);
  for (const auto& p : network.lanes[0].centre) EXPECT_LT(std::abs(p.y()), 0.2);
  EXPECT_NEAR(network.lanes[0].length_m, 100.0, 0.5);
  EXPECT_EQ(network.lanes[0].forward_passes, 16);
  EXPECT_TRUE(network.lanes[0].one_way());
}

TEST(RandomLots, OneWayRingIsOneWayAndCountsItsLaps) {
  const Lot lot = random_lot(4, 3);
  const RoadNetwork network = build_road_network(drive_lot(lot, 4, 0.2, 0.2, 3));
  ASSERT_EQ(network.lanes.size(), 1U);
  EXPECT_TRUE(network.lanes[0].closed);
  EXPECT_TRUE(network.lanes[0].one_way());
  EXPECT_EQ(network.lanes[0].forward_passes, 4);
}

TEST(RandomLots, IdsOfUnchangedLanesAreKeptOverSixUpdates) {
  int same = 0;
  int total = 0;
  for (int shape = 0; shape < kLotShapes; ++shape) {
    const Lot lot = random_lot(shape, 11);
    RoadNetwork before = build_road_network(drive_lot(lot, 1, 0.3, 0.2, 11));
    for (int laps = 2; laps <= 7; ++laps) {
      const RoadNetwork after = build_road_network(drive_lot(lot, laps, 0.3, 0.2, 11), {}, &before);
      for (const Lane& lane : before.lanes) {
        ++total;
        for (const Lane& other : after.lanes) same += lane.id == other.id ? 1 : 0;
      }
      before = after;
    }
  }
  EXPECT_GT(same, 0.98 * total);
}

}  // namespace
}  // namespace roadbook::test
