#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/random.hpp"
#include "roadnet/build_network.hpp"
#include "roadnet/paths/lane_path.hpp"

namespace roadbook {
namespace {

// Drives of some metres: one lane, or an empty network, and no fault of the fit.

// Positions each `step_m` on a straight line of this length and heading.
DrivenPass straight_pass(double length_m, double step_m, double heading_rad) {
  DrivenPass pass;
  const int steps = static_cast<int>(std::round(length_m / step_m));
  const Eigen::Vector3d along(std::cos(heading_rad), std::sin(heading_rad), 0.0);
  for (int i = 0; i <= steps; ++i) pass.positions.emplace_back(i * step_m * along);
  return pass;
}

TEST(ShortDrives, AStraightDriveOfSomeMetresIsOneLane) {
  for (const double length_m : {5.76, 5.8, 8.0, 12.0, 25.0})
    for (const double step_m : {0.1, 0.2, 0.24, 0.36, 1.0})
      for (const double heading_rad : {0.0, 0.3, 1.0, 2.0, std::numbers::pi, -1.3}) {
        SCOPED_TRACE(::testing::Message() << length_m << " " << step_m << " " << heading_rad);
        const std::vector<DrivenPass> passes{straight_pass(length_m, step_m, heading_rad)};
        const RoadNetwork network = build_road_network(passes);
        ASSERT_EQ(network.status, RoadNetworkStatus::kOk);
        ASSERT_EQ(network.lanes.size(), 1U);
        const auto paths = lane_paths(network, passes);
        ASSERT_EQ(paths.size(), 1U);
        EXPECT_EQ(paths[0].status, LanePathStatus::kOk);
        EXPECT_NEAR(paths[0].length_m, length_m, 1.1);  // the last step may be cut off
        EXPECT_LT(paths[0].deviation_m, 1e-3);
        EXPECT_LT(paths[0].max_curvature, 1e-3);
      }
}

// Whatever little was driven: a network without lanes, or lanes with paths.
void expect_network_or_none(const std::vector<DrivenPass>& passes) {
  const RoadNetwork network = build_road_network(passes);
  if (network.lanes.empty()) {
    EXPECT_EQ(network.status, RoadNetworkStatus::kEmpty);
    return;
  }
  const auto paths = lane_paths(network, passes);
  ASSERT_EQ(paths.size(), network.lanes.size());
  for (const auto& path : paths) EXPECT_TRUE(std::isfinite(path.length_m));
}

TEST(ShortDrives, DrivesOfNoLengthHaveNoLane) {
  expect_network_or_none({});
  expect_network_or_none({DrivenPass{}});
  for (const double length_m : {0.0, 1e-9, 1e-3, 0.1, 0.5, 1.0, 2.0, 4.0})
    for (const double step_m : {0.05, 0.2, 1.0}) {
      SCOPED_TRACE(::testing::Message() << length_m << " " << step_m);
      auto pass = straight_pass(length_m, step_m, 0.7);
      expect_network_or_none({pass});
      expect_network_or_none({pass, pass});
      pass.positions.push_back(pass.positions.back());
      expect_network_or_none({pass});
    }
  DrivenPass still;
  still.positions.assign(50, Eigen::Vector3d(3.0, 4.0, 0.0));
  expect_network_or_none({still});
  EXPECT_EQ(build_road_network({still}).status, RoadNetworkStatus::kEmpty);
}

TEST(ShortDrives, TurnsOnTheSpotAndThereAndBackEndWell) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed, "short drives");
    DrivenPass circle;  // radius up to 3 m, up to two rounds
    const double radius_m = random.uniform(0.0, 3.0);
    const double angle_rad = random.uniform(0.0, 12.0);
    for (int i = 0; i <= 60; ++i) {
      const double a = angle_rad * i / 60.0;
      circle.positions.emplace_back(radius_m * std::sin(a), radius_m * (1.0 - std::cos(a)), 0.0);
    }
    expect_network_or_none({circle});
    const double length_m = random.uniform(0.5, 12.0);
    DrivenPass there = straight_pass(length_m, 0.2, 0.4);
    DrivenPass back = there;
    back.reversing = true;
    std::reverse(back.positions.begin(), back.positions.end());
    expect_network_or_none({there, back});
    DrivenPass walk;  // noise about a point
    for (int i = 0; i < 40; ++i)
      walk.positions.emplace_back(random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05), 0.0);
    expect_network_or_none({walk});
  }
}

}  // namespace
}  // namespace roadbook
