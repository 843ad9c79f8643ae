#include "roadnet/build_network.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "tests/roadnet/random_lots.hpp"

namespace roadbook {
namespace {

void append_line(DrivenPass& pass, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const int pieces = static_cast<int>(std::ceil((b - a).norm() / 0.2));
  for (int k = 0; k <= pieces; ++k) pass.positions.emplace_back(a + (b - a) * k / pieces);
}

DrivenPass through(const std::vector<Eigen::Vector3d>& corners) {
  DrivenPass pass;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i)
    append_line(pass, corners[i], corners[i + 1]);
  return pass;
}

TEST(BuildRoadNetwork, KeepsTwoFloorsApartThatARampJoins) {
  // A ring on each floor, one above the other, 3 m apart; the ramp crosses the inside.
  const DrivenPass drive = through({{0, 0, 0},
                                    {60, 0, 0},
                                    {60, 40, 0},
                                    {0, 40, 0},
                                    {0, 0, 0},
                                    {-10, 20, 1.5},
                                    {0, 40, 3},
                                    {60, 40, 3},
                                    {60, 0, 3},
                                    {0, 0, 3},
                                    {0, 40, 3}});
  const RoadNetwork network = build_road_network({drive});
  EXPECT_EQ(network.status, RoadNetworkStatus::kOk);
  EXPECT_EQ(network.intersections.size(), 2U);
  EXPECT_EQ(network.lanes.size(), 3U);
  EXPECT_EQ(network.cycle_rank, 2);
  EXPECT_EQ(network.components, 1);
  for (const Lane& lane : network.lanes) {
    for (std::size_t i = 0; i + 1 < lane.centre.size(); ++i) {
      const Eigen::Vector3d d = lane.centre[i + 1] - lane.centre[i];
      EXPECT_LT(std::abs(d.z()), 0.5 * d.head<2>().norm() + 1e-9) << "steeper than any ramp";
    }
  }
}

TEST(BuildRoadNetwork, CountsReverseGearApartFromTraffic) {
  DrivenPass in = through({{0, 0, 0}, {50, 0, 0}});
  DrivenPass out = through({{50, 0, 0}, {0, 0, 0}});
  out.reversing = true;
  const RoadNetwork network = build_road_network({in, out});
  ASSERT_EQ(network.lanes.size(), 1U);
  EXPECT_EQ(network.lanes[0].forward_passes, 1);
  EXPECT_EQ(network.lanes[0].backward_passes, 0);
  EXPECT_EQ(network.lanes[0].reverse_gear_passes, 1);
  EXPECT_LT(network.lanes[0].centre.front().x(), network.lanes[0].centre.back().x());
}

TEST(BuildRoadNetwork, KeepsADrivenDeadEndToItsTip) {
  const RoadNetwork network =
      build_road_network({through({{0, 0, 0}, {80, 0, 0}}), through({{40, 0, 0}, {40, 7, 0}})});
  EXPECT_EQ(network.intersections.size(), 1U);
  ASSERT_EQ(network.lanes.size(), 3U);
  double highest = 0.0;
  for (const Lane& lane : network.lanes) {
    for (const auto& p : lane.centre) highest = std::max(highest, p.y());
  }
  EXPECT_NEAR(highest, 7.0, 0.5);
}

TEST(BuildRoadNetwork, LanesMeetAtTheirIntersections) {
  const test::Lot lot = test::random_lot(3, 2);
  const RoadNetwork network = build_road_network(test::drive_lot(lot, 3, 0.3, 0.2, 2));
  for (const Lane& lane : network.lanes) {
    ASSERT_GE(lane.from_intersection, 0);
    ASSERT_GE(lane.to_intersection, 0);
    const auto& all = network.intersections;
    EXPECT_EQ(lane.centre.front(), all[static_cast<std::size_t>(lane.from_intersection)].position);
    EXPECT_EQ(lane.centre.back(), all[static_cast<std::size_t>(lane.to_intersection)].position);
  }
}

TEST(BuildRoadNetwork, IntersectionsLieWhereTheRoadsCross) {
  const test::Lot lot = test::random_lot(3, 2);
  const RoadNetwork network = build_road_network(test::drive_lot(lot, 4, 0.2, 0.2, 2));
  for (const Intersection& found : network.intersections) {
    double nearest = std::numeric_limits<double>::max();
    for (const auto& place : lot.places) {
      nearest = std::min(nearest, (place - found.position).norm());
    }
    EXPECT_LT(nearest, network.reach_m);
  }
}

TEST(BuildRoadNetwork, GivesAnEmptyNetworkWhereNothingWasDriven) {
  const DrivenPass single{0, false, {{1, 2, 3}}};
  const DrivenPass parked{0, false, std::vector<Eigen::Vector3d>(500, {1, 2, 3})};
  for (const auto& passes :
       std::vector<std::vector<DrivenPass>>{{}, {DrivenPass{}}, {single}, {parked}}) {
    const RoadNetwork network = build_road_network(passes);
    EXPECT_EQ(network.status, RoadNetworkStatus::kEmpty);
    EXPECT_TRUE(network.lanes.empty());
    EXPECT_TRUE(network.intersections.empty());
  }
}

TEST(BuildRoadNetwork, NamesThePositionThatIsNotANumber) {
  DrivenPass pass = through({{0, 0, 0}, {50, 0, 0}});
  pass.positions[17].y() = std::numeric_limits<double>::quiet_NaN();
  try {
    static_cast<void>(build_road_network({DrivenPass{}, pass}));
    FAIL() << "accepted";
  } catch (const BadInput& error) {
    EXPECT_NE(std::string(error.what()).find("passes[1].positions[17]"), std::string::npos);
  }
}

TEST(BuildRoadNetwork, RefusesOptionsOutOfRange) {
  EXPECT_THROW(static_cast<void>(build_road_network({}, {.reach_m = -1.0})), InvalidOption);
  EXPECT_THROW(static_cast<void>(build_road_network({}, {.vertical_limit_m = 0.0})), InvalidOption);
  EXPECT_THROW(static_cast<void>(build_road_network({}, {.min_passes = 0})), InvalidOption);
}

TEST(BuildRoadNetwork, SaysSoWhenTooMuchOfTheDriveIsOffTheNetwork) {
  std::vector<DrivenPass> passes(3, through({{0, 0, 0}, {100, 0, 0}}));
  passes.push_back(through({{50, 0, 0}, {50, 60, 0}}));
  RoadNetworkOptions options;
  options.min_passes = 2;  // leaves the side road out, and a seventh of the drive with it
  EXPECT_EQ(build_road_network(passes, options).status, RoadNetworkStatus::kLowCoverage);
}

TEST(BuildRoadNetwork, StagesEndInTheLanes) {
  const test::Lot lot = test::random_lot(0, 4);
  RoadNetworkStages stages;
  const auto network =
      build_road_network(test::drive_lot(lot, 4, 0.3, 0.2, 4), {}, nullptr, &stages);
  EXPECT_EQ(stages.lanes.size(), network.lanes.size());
  EXPECT_EQ(cycle_rank(stages.finished), network.cycle_rank);
  EXPECT_GE(stages.full.size(), stages.one_loop.size());
  EXPECT_GE(stages.one_loop.size(), stages.finished.size());
}

}  // namespace
}  // namespace roadbook
