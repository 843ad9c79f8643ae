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

// The layer of one parking space: a ring of corners (x, y) with its height [m].
template <typename Height>
VectorLayer one_space(const std::vector<Eigen::Vector2d>& ring, const Height& height) {
  VectorLayer spaces;
  spaces.name = "parking_spaces";
  spaces.type = GeometryType::kPolygonZ;
  spaces.fields = {{"space", FieldType::kInteger}};
  Feature space;
  for (const Eigen::Vector2d& p : ring) space.points.emplace_back(p.x(), p.y(), height(p.x()), 0.0);
  space.values = {std::int64_t{17}};
  spaces.features = {space};
  return spaces;
}

// A rectangle whose open side faces the aisle at x = 35, 2 m to its right.
TEST(PlannerMap, ASpaceIsLinkedToTheLaneBeforeItsOpenSide) {
  const test::Folder folder;
  const auto map = test::map_with_paths(folder);
  const VectorLayer spaces =
      one_space({{42.0, 20.0}, {42.0, 22.5}, {37.0, 22.5}, {37.0, 20.0}, {42.0, 20.0}},
                [](double x) { return 0.02 * x; });
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

// A lane that rises in a loop and crosses itself on a bridge. In plan, the space beside the
// crossing is nearer to the upper part of the lane than to the lower one, which it belongs to.
TEST(PlannerMap, ASpaceUnderABridgeIsLinkedToTheLowerPartOfItsLane) {
  DrivenPass pass;
  for (double x = 0.0; x < 45.0; x += 0.2) pass.positions.emplace_back(x, 0.0, 0.0);
  for (double turn = 0.0; turn < 1.5 * M_PI; turn += 0.0133)
    pass.positions.emplace_back(45.0 + 15.0 * std::sin(turn), 15.0 - 15.0 * std::cos(turn),
                                3.0 * turn / (1.5 * M_PI));
  for (double y = 15.0; y > -25.0; y -= 0.2) pass.positions.emplace_back(30.0, y, 3.0);
  const RoadNetwork network = build_road_network({pass});
  ASSERT_EQ(network.lanes.size(), 1U);
  const test::Folder folder;
  const auto map = folder / "bridge.gpkg";
  MapFileBuilder(map, "key").finish(test::small_map(1), {});
  const VectorLayer spaces =
      one_space({{31.0, 2.5}, {33.0, 2.5}, {33.0, 7.5}, {31.0, 7.5}, {31.0, 2.5}},
                [](double) { return 0.0; });
  MapUpdate update(map);
  const NetworkSource source{"drive 0", "2014-06-24T18:02:59.763Z", 0.02};
  write_network_layers(update, network, source);
  write_path_layers(update, lane_paths(network, {pass}), network, source);
  update.write_layer(spaces);
  update.commit();
  const PlannerMap planner(map);
  ASSERT_EQ(planner.spaces().size(), 1U);
  const auto& link = planner.spaces().front().link;
  ASSERT_TRUE(link) << planner.spaces().front().no_link;
  const LanePiece& piece = planner.layout().pieces[static_cast<std::size_t>(link->piece)];
  const PathPoint at = piece.curve.at(link->s_m);
  EXPECT_NEAR(at.position.x(), 32.0, 0.2);
  EXPECT_NEAR(at.position.y(), 0.0, 0.2);
  EXPECT_NEAR(link->distance_m, 2.5, 0.2);
  EXPECT_EQ(link->left, at.tangent.x() > 0.0);  // the space lies at positive y
}

}  // namespace
}  // namespace roadbook
