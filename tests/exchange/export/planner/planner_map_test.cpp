#include "exchange/export/planner/planner_map.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/exchange/stored_speeds.hpp"

namespace roadbook {
namespace {

using test::Stored;

TEST(PlannerMap, LimitsAreNowhereFasterThanTheProfileOfTheLane) {
  const Stored stored;
  const PlannerMap planner(stored.map);
  ASSERT_TRUE(planner.speeds_known());
  const LaneLayout& layout = planner.layout();
  for (std::size_t i = 0; i < layout.pieces.size(); ++i) {
    const LanePiece& piece = layout.pieces[i];
    const LaneProfile* profile = nullptr;
    for (const LaneProfile& one : stored.speeds.profiles)
      if (one.lane == piece.id) profile = &one;
    ASSERT_NE(profile, nullptr);
    double fastest = 0.0;
    for (const SpeedPiece& part : planner.lane_speeds(static_cast<int>(i)))
      for (double s = part.begin_m; s <= part.end_m; s += 0.1) {
        const double on_lane = piece.turned ? piece.curve.length_m() - s : s;
        EXPECT_LE(part.speed, profile->speed_at(on_lane) + 1e-9);
        fastest = std::max(fastest, part.speed);
      }
    EXPECT_GT(fastest, 1.0);
  }
}

TEST(PlannerMap, TurnsAreNoFasterThanTheirBendAllows) {
  const Stored stored;
  const PlannerMap planner(stored.map);
  const LaneLayout& layout = planner.layout();
  ASSERT_GT(layout.connectors.size(), 5U);
  const double lateral = stored.speeds.options.motion.lateral;
  for (std::size_t i = 0; i < layout.connectors.size(); ++i) {
    const PathCurve& curve = layout.connectors[i].curve;
    const double speed = planner.turn_speed(static_cast<int>(i));
    EXPECT_GT(speed, 0.0);
    for (double s = 0.0; s <= curve.length_m(); s += 0.25)
      EXPECT_LE(speed * speed * std::abs(curve.at(s).curvature), lateral * 1.02);
  }
}

TEST(PlannerMap, WithoutASpeedMapBendsAndTheDefaultLimitCount) {
  const test::Folder folder;
  const PlannerMap planner(test::map_with_paths(folder));
  EXPECT_FALSE(planner.speeds_known());
  const LaneSpeedOptions defaults;
  for (std::size_t i = 0; i < planner.layout().pieces.size(); ++i)
    for (const SpeedPiece& part : planner.lane_speeds(static_cast<int>(i))) {
      EXPECT_GT(part.speed, 0.0);
      EXPECT_LE(part.speed, defaults.max_speed);
    }
}

// A rectangle whose open side faces the aisle at x = 35, 2 m to its right.
TEST(PlannerMap, ASpaceIsLinkedToTheLaneBeforeItsOpenSide) {
  const test::Folder folder;
  const auto map = test::map_with_paths(folder);
  VectorLayer spaces;
  spaces.name = "parking_spaces";
  spaces.type = GeometryType::kPolygonZ;
  spaces.fields = {{"space", FieldType::kInteger}};
  Feature space;
  for (const auto& [x, y] :
       {std::pair{42.0, 20.0}, {42.0, 22.5}, {37.0, 22.5}, {37.0, 20.0}, {42.0, 20.0}})
    space.points.emplace_back(x, y, 0.02 * x, 0.0);
  space.values = {std::int64_t{17}};
  spaces.features = {space};
  MapUpdate update(map);
  update.write_layer(spaces);
  update.commit();
  const PlannerMap planner(map);
  ASSERT_EQ(planner.spaces().size(), 1U);
  const PlannerSpace& found = planner.spaces().front();
  EXPECT_EQ(found.id, "17");
  ASSERT_TRUE(found.link) << found.no_link;
  for (int i = 0; i < 2; ++i) EXPECT_EQ(found.corners[static_cast<std::size_t>(i)].x(), 37.0);
  const LanePiece& piece = planner.layout().pieces[static_cast<std::size_t>(found.link->piece)];
  const PathPoint at = piece.curve.at(found.link->s_m);
  EXPECT_NEAR(at.position.y(), 21.25, 0.05);
  EXPECT_NEAR(found.link->distance_m, 2.0, 0.3);
  EXPECT_EQ(found.link->left, at.tangent.y() < 0.0);  // the space lies east of the aisle
}

// A ramp of one lane that winds twice about its axis: each point has the lane below or above it.
TEST(PlannerMap, ASpaceOnARampIsLinkedOnItsOwnFloor) {
  constexpr double kRadius_m = 12.0;
  constexpr double kRise_m = 3.0;  // a turn
  DrivenPass pass;
  for (double turn = 0.0; turn <= 4.0 * M_PI; turn += 0.02)
    pass.positions.emplace_back(kRadius_m * std::cos(turn), kRadius_m * std::sin(turn),
                                kRise_m * turn / (2.0 * M_PI));
  const RoadNetwork network = build_road_network({pass});
  ASSERT_EQ(network.lanes.size(), 1U);
  const auto paths = lane_paths(network, {pass});
  const test::Folder folder;
  const auto map = folder / "ramp.gpkg";
  MapFileBuilder(map, "key").finish(test::small_map(1), {});
  VectorLayer spaces;
  spaces.name = "parking_spaces";
  spaces.type = GeometryType::kPolygonZ;
  spaces.fields = {{"space", FieldType::kInteger}};
  const double heights[] = {0.25 * kRise_m, 1.25 * kRise_m};
  for (const double z : heights) {
    Feature space;
    for (const auto& [x, y] :
         {std::pair{-1.2, 14.0}, {1.2, 14.0}, {1.2, 19.0}, {-1.2, 19.0}, {-1.2, 14.0}})
      space.points.emplace_back(x, y, z, 0.0);
    space.values = {static_cast<std::int64_t>(spaces.features.size() + 1)};
    spaces.features.push_back(space);
  }
  MapUpdate update(map);
  const NetworkSource source{"drive 0", "2014-06-24T18:02:59.763Z", 0.02};
  write_network_layers(update, network, source);
  write_path_layers(update, paths, network, source);
  update.write_layer(spaces);
  update.commit();
  const PlannerMap planner(map);
  ASSERT_EQ(planner.spaces().size(), 2U);
  const double turn_m = 2.0 * M_PI * kRadius_m;
  for (std::size_t i = 0; i < 2; ++i) {
    const PlannerSpace& space = planner.spaces()[i];
    ASSERT_TRUE(space.link) << space.no_link;
    const LanePiece& piece = planner.layout().pieces[static_cast<std::size_t>(space.link->piece)];
    const bool upwards = network.lanes[0].centre.front().z() < 1.0 && !piece.turned;
    const double from_below = upwards ? space.link->s_m : piece.curve.length_m() - space.link->s_m;
    EXPECT_NEAR(from_below, (0.25 + static_cast<double>(i)) * turn_m, 1.0);
    EXPECT_NEAR(space.link->distance_m, 2.0, 0.1);
    EXPECT_EQ(space.link->left, !upwards);  // outside of a turn to the left
  }
}

}  // namespace
}  // namespace roadbook
