#include "roadnet/routing/lane_layout.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "roadnet/build_network.hpp"
#include "tests/roadnet/random_lots.hpp"

namespace roadbook {
namespace {

TEST(LaneLayout, TurnsMeetTheirLanesWithoutKinkOrJumpOfCurvature) {
  for (int shape = 0; shape < test::kLotShapes; ++shape) {
    SCOPED_TRACE(shape);
    const auto passes = test::drive_lot(test::random_lot(shape, 3), 3, 0.2, 0.2, 3);
    const RoadNetwork network = build_road_network(passes);
    const LaneLayout layout = lay_out(network, lane_paths(network, passes));
    EXPECT_EQ(layout.pieces.size(), network.lanes.size());
    for (const Connector& turn : layout.connectors) {
      const auto meet = [&](const PieceEnd& end, double s, bool into_piece) {
        const LanePiece& piece = layout.pieces[static_cast<std::size_t>(end.piece)];
        const PathPoint a = turn.curve.at(s);
        PathPoint b = piece.curve.at(end.at_end ? piece.s_end_m : piece.s_begin_m);
        if (end.at_end == into_piece) {
          b.tangent = -b.tangent;
          b.curvature = -b.curvature;
        }
        EXPECT_LT((a.position - b.position).norm(), 1e-9);
        EXPECT_LT((a.tangent - b.tangent).norm(), 1e-9);
        // Rounding of lengths of metres, over the square of the curve's speed.
        EXPECT_NEAR(a.curvature, b.curvature, 1e-8);
        EXPECT_NEAR(a.height_m, b.height_m, 1e-9);
      };
      meet(turn.from, 0.0, false);
      meet(turn.to, turn.curve.length_m(), true);
      EXPECT_GE(turn.intersection, 0);
    }
    for (const LanePiece& piece : layout.pieces) EXPECT_GT(piece.length_m(), 0.0);
  }
}

TEST(LaneLayout, AQuarterTurnBetweenStraightsIsNearAnArc) {
  PathPoint a;
  a.position = {0.0, 0.0};
  PathPoint b;
  b.position = {6.0, 6.0};
  b.tangent = Eigen::Vector2d::UnitY();
  const PathCurve turn = connecting_curve(a, b);
  // Convex, so longer than the chord and shorter than the two tangents; it turns by a right angle,
  // from and to no curvature: in its middle less than twice the mean, as a triangle would.
  EXPECT_GT(turn.length_m(), 6.0 * std::numbers::sqrt2);
  EXPECT_LT(turn.length_m(), 12.0);
  EXPECT_LT(std::abs(curvature_peak(turn, 0.0, turn.length_m()).curvature),
            2.0 * 0.5 * std::numbers::pi / turn.length_m());
  EXPECT_NEAR(turn.at(0.0).curvature, 0.0, 1e-9);
}

// A T of two-way lanes has three turns, each in both directions. If the stem is one-way, turns only
// lead out of the stem.
TEST(LaneLayout, OneWayLanesHaveTurnsTheirWayOnly) {
  RoadNetwork network;
  network.reach_m = 3.0;
  network.intersections.push_back({1, {0, 0, 0}});
  const auto lane = [](std::uint64_t id, const Eigen::Vector3d& far, int backward) {
    Lane l;
    l.id = id;
    for (int i = 0; i <= 40; ++i) l.centre.push_back(far * (40 - i) / 40.0);
    l.to_intersection = 0;
    l.forward_passes = 1;
    l.backward_passes = backward;
    l.length_m = far.norm();
    return l;
  };
  network.lanes = {lane(1, {-40, 0, 0}, 1), lane(2, {40, 0, 0}, 1), lane(3, {0, -40, 0}, 1)};
  const auto count = [&] {
    const LaneLayout layout = lay_out(network, lane_paths(network, {}));
    int ways = 0;
    for (const Connector& turn : layout.connectors) ways += turn.both_ways ? 2 : 1;
    return std::pair{layout.connectors.size(), ways};
  };
  EXPECT_EQ(count(), (std::pair<std::size_t, int>{3, 6}));
  network.lanes[2] = lane(3, {0, -40, 0}, 0);
  EXPECT_EQ(count(), (std::pair<std::size_t, int>{3, 4}));
}

// A lane that keeps an old direction although all traffic is now against it is written turned.
TEST(LaneLayout, ALaneDrivenAgainstItsDirectionOnlyIsTurnedRound) {
  RoadNetwork network;
  Lane l;
  l.id = 4;
  for (int i = 0; i <= 40; ++i) l.centre.emplace_back(i, 0.0, 0.0);
  l.backward_passes = 2;
  l.length_m = 40.0;
  network.lanes = {l};
  const LaneLayout layout = lay_out(network, lane_paths(network, {}));
  ASSERT_EQ(layout.pieces.size(), 1U);
  EXPECT_TRUE(layout.pieces[0].turned);
  EXPECT_FALSE(layout.pieces[0].both_ways);
  EXPECT_NEAR(layout.pieces[0].curve.at(0.0).position.x(), 40.0, 1e-9);
}

}  // namespace
}  // namespace roadbook
