#include "roadnet/paths/lane_path.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "base/random.hpp"
#include "roadnet/build_network.hpp"
#include "roadnet/paths/path_frame.hpp"
#include "tests/roadnet/random_lots.hpp"
#include "tests/roadnet/rounded_roads.hpp"

namespace roadbook {
namespace {

TEST(LanePath, ARingWithRoundedCornersIsFollowedWithin20CentimetresAndBendsAsItsCorners) {
  const test::RoundedRectangle road{60.0, 35.0, 5.5};
  const auto passes = test::drive_round(road, 5, 0.2, 1);
  const RoadNetwork network = build_road_network(passes);
  ASSERT_EQ(network.lanes.size(), 1U);
  const auto paths = lane_paths(network, passes);
  ASSERT_EQ(paths.size(), 1U);
  const LanePath& lane = paths[0];
  EXPECT_EQ(lane.lane, network.lanes[0].id);
  EXPECT_EQ(lane.status, LanePathStatus::kOk) << lane.deviation_m << " at " << lane.deviation_s_m;
  EXPECT_LT(lane.deviation_m, 0.2);
  EXPECT_TRUE(lane.path.closed);
  const PathCurve curve(lane.path);
  // The passes' mean is off by 0.2 / sqrt(5) = 0.09 m at one sigma; three of them.
  double worst = 0.0;
  for (double s = 0.0; s < curve.length_m(); s += 0.25)
    worst = std::max(worst, std::abs(road.distance(curve.at(s).position)));
  EXPECT_LT(worst, 0.27 + 0.2);
  EXPECT_NEAR(lane.length_m, road.length(), 2.0);
  // Corners of 5.5 m: a smooth curve through an arc's ends bends up to a half more inside.
  EXPECT_GT(lane.max_curvature, 0.8 / 5.5);
  EXPECT_LT(lane.max_curvature, 1.5 / 5.5);
  // 95 % of a normal scatter of 0.2 m, from five correlated laps.
  EXPECT_NEAR(lane.width_m, 1.9 + 0.8, 0.4);
  EXPECT_GT(lane.tube_m, 3.0);
}

TEST(LanePath, LanesThatMeetShareTheEndOfTheirPaths) {
  for (int shape = 0; shape < test::kLotShapes; ++shape) {
    SCOPED_TRACE(shape);
    const auto passes = test::drive_lot(test::random_lot(shape, 5), 4, 0.3, 0.2, 5);
    const RoadNetwork network = build_road_network(passes);
    const auto paths = lane_paths(network, passes);
    ASSERT_EQ(paths.size(), network.lanes.size());
    for (std::size_t i = 0; i < paths.size(); ++i) {
      const Lane& lane = network.lanes[i];
      EXPECT_NE(paths[i].status, LanePathStatus::kDegenerate);
      const JointJumps jumps = joint_jumps(paths[i].path);
      EXPECT_LT(jumps.position_m, 1e-9);
      EXPECT_LT(jumps.first, 1e-9);
      EXPECT_LT(jumps.second, 1e-9);
      if (lane.closed) continue;
      EXPECT_EQ(paths[i].path.points.front(), lane.centre.front());
      EXPECT_EQ(paths[i].path.points.back(), lane.centre.back());
    }
  }
}

// Measures the claimed values again: the deviation from stretches of 1 m, and the curvature from
// differences.
TEST(LanePath, ReportedDeviationAndCurvatureAreThoseOfThePath) {
  const test::RoundedRectangle road{50.0, 30.0, 5.0};
  const auto passes = test::drive_round(road, 3, 0.3, 9);
  const RoadNetwork network = build_road_network(passes);
  const LanePath lane = lane_paths(network, passes).at(0);
  const PathFrame frame(PathCurve(lane.path), {-2.5, 2.5});
  std::map<int, std::pair<double, int>> stretches;
  for (const DrivenPass& pass : passes)
    for (const auto& p : pass.positions) {
      const auto at = frame.project(p.head<2>());
      if (!at.inside()) continue;
      stretches[static_cast<int>(at.s_m)].first += at.e_m;
      ++stretches[static_cast<int>(at.s_m)].second;
    }
  double worst = 0.0;
  for (const auto& [s, sum] : stretches) worst = std::max(worst, std::abs(sum.first / sum.second));
  // Other samples of the same drive, five a metre and pass instead of two.
  EXPECT_NEAR(lane.deviation_m, worst, 0.05);
  double tightest = 0.0;
  const double h = 0.01;
  for (double s = 1.0; s < lane.length_m - 1.0; s += 0.05)
    tightest = std::max(tightest, std::abs(std::remainder(frame.curve().at(s + h).heading() -
                                                              frame.curve().at(s - h).heading(),
                                                          2.0 * std::numbers::pi)) /
                                      (2.0 * h));
  EXPECT_NEAR(lane.max_curvature, tightest, 1e-3);
}

TEST(LanePath, AnyNumberOfThreadsGivesTheSamePaths) {
  const auto passes = test::drive_lot(test::random_lot(3, 2), 3, 0.3, 0.2, 2);
  const RoadNetwork network = build_road_network(passes);
  const auto one = lane_paths(network, passes, {}, 1);
  const auto four = lane_paths(network, passes, {}, 4);
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(one[i].path.points, four[i].path.points);
}

TEST(LanePath, ALaneWithoutLengthAndBadPositionsAreNamed) {
  RoadNetwork network;
  network.lanes.resize(1);
  network.lanes[0].id = 77;
  network.lanes[0].centre = {{1, 1, 0}, {1, 1, 0}};
  EXPECT_EQ(lane_paths(network, {}).at(0).status, LanePathStatus::kDegenerate);
  network.lanes[0].centre = {{1, 1, 0}, {std::nan(""), 1, 0}};
  try {
    (void)lane_paths(network, {});
    FAIL();
  } catch (const BadInput& bad) {
    EXPECT_NE(std::string(bad.what()).find("lane 77"), std::string::npos) << bad.what();
  }
  EXPECT_THROW((void)lane_paths(network, {}, {.max_deviation_m = -1.0}), InvalidOption);
}

}  // namespace
}  // namespace roadbook
