#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"
#include "roadnet/build_network.hpp"
#include "roadnet/paths/lane_path.hpp"
#include "roadnet/paths/path_curve.hpp"
#include "roadnet/routing/lane_link.hpp"
#include "sim/scenario/scenario.hpp"
#include "sim/world/layout.hpp"
#include "sim/world/path.hpp"

// The car parks of [metric-semantic maps, section VI]: 80 spaces (Zurich) and 164 (Stuttgart),
// driven as their scenarios say, each space linked to its lane and reached from where the drive
// begins.

namespace roadbook {
namespace {

// Laps of the scenario's route, each with its own offset and wander, as far as a driver's is.
std::vector<DrivenPass> drive(const Scenario& scenario, int laps, std::uint64_t seed) {
  const DrivingLine line = route_line(scenario, scenario.route);
  Random random(seed, "laps");
  DrivenPass pass;
  for (int lap = 0; lap < laps; ++lap) {
    const double offset = random.normal(0.0, 0.15);
    const double phase = random.uniform(0.0, 6.0);
    for (double s = 0.0; s < line.length_m(); s += 0.2) {
      const double e = offset + 0.1 * std::sin(s / 12.0 + phase);
      const Eigen::Vector2d p = line.at(s);
      const double heading = line.heading(s);
      pass.positions.emplace_back(p.x() - e * std::sin(heading), p.y() + e * std::cos(heading),
                                  0.0);
    }
  }
  return {pass};
}

std::vector<SpacePlace> spaces_of(const Scenario& scenario) {
  std::vector<SpacePlace> spaces;
  for (const ParkingSpace& space : make_layout(scenario).spaces) {
    std::vector<Eigen::Vector3d> corners;
    for (const auto& c : space.corners) corners.emplace_back(c.x(), c.y(), 0.0);
    spaces.push_back(space_place(static_cast<std::uint64_t>(space.id), corners));
    EXPECT_NEAR(spaces.back().outwards.x(), std::cos(space.heading), 1e-9);
    EXPECT_NEAR(spaces.back().outwards.y(), std::sin(space.heading), 1e-9);
  }
  return spaces;
}

TEST(ParkingAccess, EverySpaceOfBothCarParksIsReachedOrNamed) {
  for (const auto& [name, count] : {std::pair{"zurich", 80U}, {"stuttgart", 164U}}) {
    SCOPED_TRACE(name);
    const Scenario scenario = load_scenario(name);
    const auto passes = drive(scenario, 3, 1);
    const RoadNetwork network = build_road_network(passes);
    ASSERT_EQ(network.status, RoadNetworkStatus::kOk);
    const auto spaces = spaces_of(scenario);
    ASSERT_EQ(spaces.size(), count);
    const auto links = link_spaces(network, spaces);
    const auto entrance = nearest_place(network, passes[0].positions.front(), 5.0);
    ASSERT_TRUE(entrance);
    const auto access = space_access(Router(network), links, *entrance);
    int reached = 0;
    for (std::size_t i = 0; i < access.size(); ++i) {
      EXPECT_EQ(access[i].reachable, access[i].reason.empty()) << access[i].reason;
      reached += access[i].reachable ? 1 : 0;
      if (!access[i].reachable) continue;
      // Judged by the scenario: the lane's centre at the link is a lane of the scenario, and lies
      // in front of the space, not behind it.
      const Lane& lane = network.lanes[static_cast<std::size_t>(links[i].place.lane)];
      const Eigen::Vector3d at = lane_spot(lane, links[i].place.s_m).position;
      EXPECT_GT((at - spaces[i].front).head<2>().dot(spaces[i].outwards), 0.0);
      EXPECT_LE(links[i].place.distance_m, 10.0);
    }
    std::printf("%s: %d of %u spaces reached, %zu lanes\n", name, reached, count,
                network.lanes.size());
    // All of them face the driven ring or an aisle.
    EXPECT_EQ(reached, static_cast<int>(count));
  }
}

TEST(ParkingAccess, ASpaceBehindAOneWayLaneIsNamedWithTheReason) {
  Scenario scenario = load_scenario("stuttgart");
  const auto passes = drive(scenario, 2, 2);
  RoadNetwork network = build_road_network(passes);
  // A road of its own, far away, with a space beside it: no way leads there.
  Lane island;
  island.id = 999;
  for (int i = 0; i <= 20; ++i) island.centre.emplace_back(300.0 + i, 0.0, 0.0);
  island.length_m = 20.0;
  island.forward_passes = 1;
  network.lanes.push_back(island);
  std::vector<SpacePlace> spaces;
  spaces.push_back({1, {310.0, 4.0, 0.0}, {0.0, -1.0}});
  spaces.push_back({2, {310.0, 4.0, 0.0}, {0.0, 1.0}});
  spaces.push_back({3, {310.0, 60.0, 0.0}, {0.0, 1.0}});
  const auto links = link_spaces(network, spaces);
  EXPECT_EQ(links[0].status, LinkStatus::kLinked);
  EXPECT_TRUE(links[0].left);
  EXPECT_EQ(links[1].status, LinkStatus::kNotBefore);
  EXPECT_EQ(links[2].status, LinkStatus::kNoLaneNear);
  const auto entrance = nearest_place(network, passes[0].positions.front(), 5.0);
  const auto access = space_access(Router(network), links, *entrance);
  EXPECT_EQ(access[0].reason, "way in: no chain of lanes leads there");
  EXPECT_EQ(access[1].reason, "lane 999, 4.00 m away, lies beside or behind it");
  EXPECT_EQ(access[2].reason, "no lane within 10.00 m");
  // From a place 8 m before it on its own lane there is a way in, and no way back.
  const auto before = nearest_place(network, {302.0, 0.0, 0.0}, 5.0);
  ASSERT_TRUE(before);
  const auto ahead = space_access(Router(network), links, *before);
  EXPECT_NEAR(ahead[0].way_in_m, 8.0, 1e-6);
  EXPECT_EQ(ahead[0].reason, "way out: lanes lead there only against the way they were driven");
}

// The lanes of the scenario are the truth: straights and arcs of the turning radius.
TEST(ParkingAccess, PathsOfTheLanesFollowTheScenariosLanes) {
  for (const char* name : {"zurich", "stuttgart"}) {
    SCOPED_TRACE(name);
    const Scenario scenario = load_scenario(name);
    const auto passes = drive(scenario, 5, 3);
    const RoadNetwork network = build_road_network(passes);
    const auto paths = lane_paths(network, passes);
    double deviation = 0.0;
    double curvature = 0.0;
    for (const LanePath& path : paths) {
      EXPECT_EQ(path.status, LanePathStatus::kOk)
          << path.deviation_m << " at " << path.deviation_s_m << " of " << path.length_m;
      deviation = std::max(deviation, path.deviation_m);
      curvature = std::max(curvature, path.max_curvature);
    }
    std::printf("%s: deviation at most %.3f m, curvature at most %.3f 1/m (turns of %.1f m)\n",
                name, deviation, curvature, scenario.vehicle.turn_radius_m);
    EXPECT_LT(deviation, 0.2);
    EXPECT_LT(curvature, 0.5);
  }
}

}  // namespace
}  // namespace roadbook
