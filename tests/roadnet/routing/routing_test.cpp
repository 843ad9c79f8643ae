#include "roadnet/routing/routing.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <numbers>

#include "base/error.hpp"
#include "base/random.hpp"
#include "roadnet/build_network.hpp"
#include "roadnet/routing/route_states.hpp"
#include "tests/roadnet/random_lots.hpp"

namespace roadbook {
namespace {

Lane straight(std::uint64_t id,
              const Eigen::Vector3d& a,
              const Eigen::Vector3d& b,
              int from,
              int to,
              int forward = 1,
              int backward = 1,
              int reverse = 0) {
  Lane lane;
  lane.id = id;
  for (int i = 0; i <= 10; ++i) lane.centre.push_back(a + (b - a) * i / 10.0);
  lane.from_intersection = from;
  lane.to_intersection = to;
  lane.forward_passes = forward;
  lane.backward_passes = backward;
  lane.reverse_gear_passes = reverse;
  lane.length_m = (b - a).norm();
  return lane;
}

// A square of 40 m whose sides are lanes 0 to 3, with a way in (4) from the south-west corner.
RoadNetwork square(int backward) {
  RoadNetwork network;
  const Eigen::Vector3d corner[] = {{0, 0, 0}, {40, 0, 0}, {40, 40, 0}, {0, 40, 0}};
  for (int i = 0; i < 4; ++i) {
    network.intersections.push_back({static_cast<std::uint64_t>(100 + i), corner[i]});
    network.lanes.push_back(straight(static_cast<std::uint64_t>(i), corner[i], corner[(i + 1) % 4],
                                     i, (i + 1) % 4, 1, backward));
  }
  network.lanes.push_back(straight(4, {-30, 0, 0}, corner[0], -1, 0));
  return network;
}

std::vector<std::uint64_t> ids(const Route& route) {
  std::vector<std::uint64_t> list;
  for (const RouteLeg& leg : route.legs) list.push_back(leg.id);
  return list;
}

TEST(Routing, TakesTheShorterWayRound) {
  const RoadNetwork network = square(1);
  const Router router(network);
  const Route route = router.route({4, 10.0, 0.0}, {3, 30.0, 0.0});
  ASSERT_EQ(route.status, RouteStatus::kFound);
  EXPECT_EQ(ids(route), (std::vector<std::uint64_t>{4, 3}));
  EXPECT_FALSE(route.legs[1].along);
  EXPECT_DOUBLE_EQ(route.length_m, 20.0 + 10.0);
  EXPECT_NEAR(route.cost_m, 30.0 + std::numbers::pi / 2.0, 1e-12);
  const auto line = route_line(network, route);
  EXPECT_LT((line.front() - Eigen::Vector3d(-20, 0, 0)).norm(), 1e-12);
  EXPECT_LT((line.back() - Eigen::Vector3d(0, 10, 0)).norm(), 1e-12);
  double length = 0.0;
  for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
  EXPECT_NEAR(length, route.length_m, 1e-9);
}

TEST(Routing, TheLineOfARouteHasTheBendsBetweenItsEndsAndNoOthers) {
  RoadNetwork network = square(1);
  network.lanes[0].centre = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {20, 10, 0}};
  const auto expect_line = [&](const RouteLeg& leg, const std::vector<Eigen::Vector3d>& points) {
    Route route;
    route.legs = {leg};
    const auto line = route_line(network, route);
    ASSERT_EQ(line.size(), points.size());
    for (std::size_t i = 0; i < line.size(); ++i) EXPECT_LT((line[i] - points[i]).norm(), 1e-12);
  };
  expect_line({.lane = 0, .from_s_m = 5.0, .to_s_m = 15.0}, {{5, 0, 0}, {10, 0, 0}, {10, 5, 0}});
  expect_line({.lane = 0, .along = false, .from_s_m = 25.0, .to_s_m = 5.0},
              {{15, 10, 0}, {10, 10, 0}, {10, 0, 0}, {5, 0, 0}});
}

TEST(Routing, OneWayLanesAreDrivenOnlyTheirWay) {
  const RoadNetwork network = square(0);
  const Router router(network);
  const Route route = router.route({4, 10.0, 0.0}, {3, 30.0, 0.0});
  ASSERT_EQ(route.status, RouteStatus::kFound);
  EXPECT_EQ(ids(route), (std::vector<std::uint64_t>{4, 0, 1, 2, 3}));
  EXPECT_DOUBLE_EQ(route.length_m, 20.0 + 120.0 + 30.0);
  // On the lane itself: a little ahead is near, a little behind is once round.
  EXPECT_DOUBLE_EQ(router.route({1, 10.0, 0.0}, {1, 12.0, 0.0}).length_m, 2.0);
  EXPECT_DOUBLE_EQ(router.route({1, 12.0, 0.0}, {1, 10.0, 0.0}).length_m, 158.0);
}

TEST(Routing, ADeadEndThatWasOnlyDrivenIntoIsLeftBackwards) {
  RoadNetwork network;
  network.intersections.push_back({1, {0, 0, 0}});
  network.lanes = {straight(10, {-40, 0, 0}, {0, 0, 0}, -1, 0),
                   straight(11, {0, 0, 0}, {40, 0, 0}, 0, -1),
                   straight(12, {0, 0, 0}, {0, 20, 0}, 0, -1, 1, 0, 1)};
  const Router router(network);
  const Route route = router.route({2, 15.0, 0.0}, {0, 20.0, 0.0});
  ASSERT_EQ(route.status, RouteStatus::kFound);
  ASSERT_EQ(route.legs.size(), 2U);
  EXPECT_EQ(route.legs[0].gear, Gear::kReverse);
  EXPECT_FALSE(route.legs[0].along);
  EXPECT_EQ(route.legs[1].gear, Gear::kForward);
  // Out of the dead end backwards at three times the cost, gears changed, a quarter turn.
  EXPECT_NEAR(route.cost_m, 45.0 + 10.0 + std::numbers::pi / 2.0 + 20.0, 1e-12);
  // Without reversing, no route exists. The status gives the reason.
  const Router forwards(network, {.allow_reverse = false});
  EXPECT_EQ(forwards.route({2, 15.0, 0.0}, {0, 20.0, 0.0}).status, RouteStatus::kOnlyAgainstWay);
  EXPECT_EQ(forwards.route({0, 20.0, 0.0}, {2, 15.0, 0.0}).status, RouteStatus::kFound);
}

TEST(Routing, NobodyTurnsRoundAtACrossingButAtADeadEndThatIsLeftForwards) {
  RoadNetwork network;
  network.intersections.push_back({1, {0, 0, 0}});
  network.lanes = {straight(10, {-40, 0, 0}, {0, 0, 0}, -1, 0),
                   straight(11, {0, 0, 0}, {60, 0, 0}, 0, -1),
                   straight(12, {0, 0, 0}, {50, 10, 0}, 0, -1)};  // sharply next to lane 11
  const Router router(network);
  // From 11 to 12 the turn is 2.9 rad. The route uses the dead end of 10, where a vehicle can turn.
  const Route route = router.route({1, 30.0, 0.0}, {2, 20.0, 0.0});
  ASSERT_EQ(route.status, RouteStatus::kFound);
  // Cheapest: on to the end of 11, round, and back? No: that ends at the same sharp turn.
  EXPECT_EQ(ids(route), (std::vector<std::uint64_t>{11, 10, 10, 12}));
  EXPECT_NEAR(route.length_m, 30.0 + 40.0 + 40.0 + 20.0, 1e-9);
}

TEST(Routing, SaysWhetherLanesAreApartOrOnlyTheWayIsWrong) {
  RoadNetwork network = square(0);
  network.lanes.push_back(straight(9, {500, 0, 0}, {540, 0, 0}, -1, -1));
  const Router router(network);
  EXPECT_EQ(router.route({0, 1.0, 0.0}, {5, 1.0, 0.0}).status, RouteStatus::kNotConnected);
  network.lanes[4].backward_passes = 0;
  const Router in_only(network);
  EXPECT_EQ(in_only.route({0, 1.0, 0.0}, {4, 1.0, 0.0}).status, RouteStatus::kOnlyAgainstWay);
  EXPECT_TRUE(in_only.route({0, 1.0, 0.0}, {4, 1.0, 0.0}).legs.empty());
  EXPECT_THROW((void)router.route({17, 0.0, 0.0}, {0, 0.0, 0.0}), InvalidOption);
  EXPECT_THROW((void)router.route({0, 41.0, 0.0}, {0, 0.0, 0.0}), InvalidOption);
  EXPECT_THROW(Router(network, {.reverse_factor = 0.5}), InvalidOption);
}

TEST(Routing, ARingIsDrivenRoundItsSeam) {
  RoadNetwork network;
  Lane ring;
  ring.id = 5;
  ring.closed = true;
  ring.forward_passes = 3;
  for (int i = 0; i <= 100; ++i) {
    const double a = 2.0 * std::numbers::pi * i / 100;
    ring.centre.emplace_back(20.0 * std::cos(a), 20.0 * std::sin(a), 0.0);
  }
  for (int i = 0; i < 100; ++i)
    ring.length_m +=
        (ring.centre[static_cast<std::size_t>(i + 1)] - ring.centre[static_cast<std::size_t>(i)])
            .norm();
  network.lanes = {ring};
  const Router router(network);
  const Route over = router.route({0, ring.length_m - 10.0, 0.0}, {0, 5.0, 0.0});
  ASSERT_EQ(over.status, RouteStatus::kFound);
  EXPECT_NEAR(over.length_m, 15.0, 1e-9);
  EXPECT_EQ(over.legs.size(), 2U);
}

// The slow reference tries every chain of states without repetition.
double cheapest_by_trying_all(const RoadNetwork& network,
                              const NetworkPlace& from,
                              const NetworkPlace& to,
                              const RoutingOptions& options) {
  const auto states = lane_states(network, options);
  const auto length = [&](const LaneState& s) {
    return network.lanes[static_cast<std::size_t>(s.lane)].length_m;
  };
  double best = std::numeric_limits<double>::infinity();
  std::vector<bool> used(states.size(), false);
  std::function<void(std::size_t, double, double)> go = [&](std::size_t i, double begin,
                                                            double cost) {
    const LaneState& state = states[i];
    const double at_goal = state.along ? to.s_m : length(state) - to.s_m;
    if (cost >= best) return;
    if (state.lane == to.lane && at_goal >= begin)
      best = std::min(best, cost + (at_goal - begin) * state.cost_per_m);
    for (std::size_t k = 0; k < states.size(); ++k) {
      const auto over = transition_cost(state, states[k], options);
      if (!over || used[k]) continue;
      used[k] = true;
      go(k, 0.0, cost + (length(state) - begin) * state.cost_per_m + *over);
      used[k] = false;
    }
  };
  for (std::size_t i = 0; i < states.size(); ++i)
    if (states[i].lane == from.lane)
      go(i, states[i].along ? from.s_m : length(states[i]) - from.s_m, 0.0);
  return best;
}

TEST(Routing, IsAsCheapAsTheBestOfAllChainsOnDrivenLots) {
  int found = 0;
  for (std::uint64_t seed = 0; seed < 14; ++seed) {
    const test::Lot lot = test::random_lot(static_cast<int>(seed) % test::kLotShapes, seed);
    const RoadNetwork network = build_road_network(test::drive_lot(lot, 1, 0.2, 0.2, seed));
    const Router router(network);
    Random random(seed, "places");
    for (int i = 0; i < 12; ++i) {
      const auto place = [&] {
        const int lane = static_cast<int>(random.below(network.lanes.size()));
        const double length = network.lanes[static_cast<std::size_t>(lane)].length_m;
        return NetworkPlace{lane, random.uniform(0.0, length), 0.0};
      };
      const NetworkPlace from = place();
      const NetworkPlace to = place();
      const double expected = cheapest_by_trying_all(network, from, to, {});
      const Route route = router.route(from, to);
      EXPECT_EQ(route.status == RouteStatus::kFound, std::isfinite(expected)) << seed;
      if (route.status != RouteStatus::kFound) continue;
      ++found;
      EXPECT_NEAR(route.cost_m, expected, 1e-9) << "seed " << seed;
      double length = 0.0;
      for (const RouteLeg& leg : route.legs) {
        EXPECT_GE(leg.length_m(), -1e-9);
        length += leg.length_m();
      }
      EXPECT_NEAR(length, route.length_m, 1e-9);
    }
  }
  EXPECT_GT(found, 100);
}

TEST(Routing, FindsTheNearestPlaceOnTheRightFloor) {
  RoadNetwork network = square(1);
  network.lanes.push_back(straight(8, {0, 1, 3}, {40, 1, 3}, -1, -1));
  const auto below = nearest_place(network, {12.0, 0.9, 0.0}, 5.0);
  ASSERT_TRUE(below);
  EXPECT_EQ(below->lane, 0);
  EXPECT_NEAR(below->s_m, 12.0, 1e-12);
  EXPECT_NEAR(below->distance_m, 0.9, 1e-12);
  const auto above = nearest_place(network, {12.0, 0.1, 2.9}, 5.0);
  ASSERT_TRUE(above);
  EXPECT_EQ(above->lane, 5);
  EXPECT_FALSE(nearest_place(network, {20.0, 20.0, 0.0}, 5.0));
  // Without a height any floor will do.
  EXPECT_TRUE(nearest_place(network, {12.0, 0.1, std::nan("")}, 5.0));
}

}  // namespace
}  // namespace roadbook
