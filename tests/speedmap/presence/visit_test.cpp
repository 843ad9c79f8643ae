#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "base/error.hpp"
#include "speedmap/presence/map_ages.hpp"
#include "speedmap/presence/presence_map.hpp"
#include "speedmap/presence/visit_evidence.hpp"

namespace roadbook {
namespace {

// A lane of 40 m along x. A crossing lies over its middle and a parking space next to it.
PresenceGrid small_place(const PresenceOptions& options = {}) {
  const GridLane lane{{{0.0, 0.0}, {20.0, 0.0}, {40.0, 0.0}}, 3.0};
  const Outline crossing{{19.0, -5.0}, {21.0, -5.0}, {21.0, 5.0}, {19.0, 5.0}};
  const Outline space{{5.0, 2.0}, {7.5, 2.0}, {7.5, 6.0}, {5.0, 6.0}};
  return {{lane}, {space}, {crossing}, options};
}

PlaceClass class_at(const PresenceGrid& grid, double x, double y) {
  return grid.place_class(static_cast<std::size_t>(grid.node_at({x, y}).value()));
}

// A drive along the lane at 4 m/s. A person is at `person` if it has a value.
std::vector<VisitFrame> drive_past(const std::optional<Eigen::Vector2d>& person) {
  std::vector<VisitFrame> frames;
  for (double x = 0.0; x <= 40.0; x += 0.8) {
    VisitFrame frame{{x, 0.0}, 0.2, {}};
    if (person && (*person - frame.position).norm() < 12.0) frame.people.push_back({*person});
    frames.push_back(frame);
  }
  return frames;
}

double presence_after(const PresenceGrid& grid,
                      int visits,
                      const std::optional<Eigen::Vector2d>& person,
                      const Eigen::Vector2d& at) {
  PresenceMap map(grid.graph());
  const auto frames = drive_past(person);
  const SightOptions sight;
  const VisitEvidence evidence = gather_evidence(grid, frames, {}, sight);
  for (int k = 0; k < visits; ++k) map.add(observations_of(grid, evidence, frames, sight));
  map.solve();
  return map.presence()[grid.node_at(at).value()];
}

TEST(Visit, EveryTwoCellsWithACommonSideAreJoinedOnce) {
  const PresenceGrid grid = small_place();
  std::set<std::pair<int, int>> joined;
  for (const PresenceEdge& edge : grid.graph().edges) {
    const auto centre = [&](int node) { return grid.centres()[static_cast<std::size_t>(node)]; };
    EXPECT_NEAR((centre(edge.a) - centre(edge.b)).norm(), grid.options().cell_m, 1e-9);
    EXPECT_TRUE(joined.insert(std::minmax(edge.a, edge.b)).second);
  }
  std::size_t sides = 0;
  for (const Eigen::Vector2d& centre : grid.centres())
    for (const Eigen::Vector2d& step : {Eigen::Vector2d(0.5, 0.0), Eigen::Vector2d(0.0, 0.5)})
      sides += grid.node_at(centre + step).has_value() ? 1U : 0U;
  EXPECT_EQ(joined.size(), sides);
}

TEST(Visit, PlacesHaveTheClassOfTheirLabels) {
  const PresenceGrid grid = small_place();
  EXPECT_EQ(class_at(grid, 20.2, 0.2), PlaceClass::kCrossing);
  EXPECT_EQ(class_at(grid, 6.0, 4.0), PlaceClass::kSpace);
  EXPECT_EQ(class_at(grid, 12.0, 1.0), PlaceClass::kLane);
  EXPECT_EQ(class_at(grid, 12.0, 4.0), PlaceClass::kOther);
  EXPECT_FALSE(grid.node_at({12.0, 9.0}).has_value());
  EXPECT_FALSE(grid.node_at({NAN, 0.0}).has_value());
  // 52 x 12 m without its rounded corners: (4 - pi) 6^2, to a cell's width along the border.
  EXPECT_NEAR(0.25 * static_cast<double>(grid.size()), 52.0 * 12.0 - 0.858 * 36.0, 16.0);
}

TEST(Visit, TheResultDoesNotDependOnTheSizeOfTheCells) {
  PresenceOptions fine;
  fine.cell_m = 0.25;
  const Eigen::Vector2d person(20.1, 1.1);
  for (const Eigen::Vector2d& at :
       {Eigen::Vector2d(20.1, 1.1), Eigen::Vector2d(20.1, 2.6), Eigen::Vector2d(25.1, 0.1)})
    EXPECT_NEAR(presence_after(small_place(), 2, person, at),
                presence_after(small_place(fine), 2, person, at), 0.04);
}

TEST(Visit, SeeingSomebodyRaisesDangerThereAndFadesWithinTheReach) {
  const PresenceGrid grid = small_place();
  const Eigen::Vector2d person(20.1, 1.1);
  const double before = presence_after(grid, 0, {}, person);
  const double after = presence_after(grid, 3, person, person);
  EXPECT_GT(after, before + 0.25);
  EXPECT_LT(presence_after(grid, 3, person, {30.1, 1.1}), 0.05);
  EXPECT_GT(after, presence_after(grid, 3, person, person + Eigen::Vector2d(0.0, 2.0)));
}

// Six visits without any person.
TEST(Visit, SeeingNobodySixTimesMakesAPlaceSafe) {
  const PresenceGrid grid = small_place();
  const Eigen::Vector2d person(20.1, 1.1);
  const SightOptions sight;
  PresenceMap map(grid.graph());
  const auto busy = drive_past(person);
  const auto calm = drive_past({});
  map.add(observations_of(grid, gather_evidence(grid, busy, {}, sight), busy, sight));
  map.solve();
  const int node = grid.node_at(person).value();
  const double peak = map.presence()[node];
  const double background = map.presence()[grid.node_at({35.1, 1.1}).value()];
  for (int k = 0; k < 6; ++k)
    map.add(observations_of(grid, gather_evidence(grid, calm, {}, sight), calm, sight));
  map.solve();
  EXPECT_LT(map.presence()[node], 0.5 * peak);
  EXPECT_LT(map.presence()[grid.node_at({35.1, 1.1}).value()], 0.5 * background);
}

// A person whose position is uncertain by metres is still one person. The danger at each place is
// smaller, and it spreads over more places.
TEST(Visit, AnUncertainPlaceSpreadsDangerAndAddsNone) {
  const PresenceGrid grid = small_place();
  const auto seconds_of = [&](double sigma_m) {
    VisitFrame frame{{10.0, 0.0}, 0.5, {}};
    frame.people.push_back({{20.0, 0.0}});
    frame.people.front().sigma_m = sigma_m;
    const auto evidence = gather_evidence(grid, {frame}, {}, SightOptions{});
    double sum = 0.0;
    double most = 0.0;
    for (const double s : evidence.person_s) {
      sum += s;
      most = std::max(most, s);
    }
    return std::pair(sum, most);
  };
  const auto [sure_sum, sure_most] = seconds_of(0.0);
  const auto [vague_sum, vague_most] = seconds_of(2.0);
  EXPECT_LT(vague_most, 0.3 * sure_most);  // person_m is 1: a fifth of the ground's share
  EXPECT_LT(vague_sum, 1.2 * sure_sum);    // cells at the rims are counted whole
}

TEST(Visit, TheLiteralModeLearnsNothingFromSeeingNobody) {
  PresenceOptions literal;
  literal.literal = true;
  const PresenceGrid grid = small_place(literal);
  const Eigen::Vector2d place(20.1, 1.1);
  EXPECT_EQ(presence_after(grid, 6, {}, place), presence_after(grid, 0, {}, place));
  EXPECT_GT(presence_after(grid, 1, place, place), presence_after(grid, 0, {}, place));
}

TEST(Visit, WhatStandsBehindAWallIsNotSeenEmpty) {
  const PresenceGrid grid = small_place();
  const std::vector<SightBlocker> wall{{{10.0, 2.0}, {30.0, 2.0}}};
  const VisitEvidence evidence = gather_evidence(grid, drive_past({}), wall, {});
  EXPECT_EQ(evidence.seen_s[static_cast<std::size_t>(grid.node_at({20.1, 5.1}).value())], 0.0);
  // From 12 m before to 12 m behind: 24 m at 4 m/s.
  EXPECT_NEAR(evidence.seen_s[static_cast<std::size_t>(grid.node_at({20.1, 0.1}).value())], 6.0,
              0.2);
}

TEST(Visit, AVisitNeverTellsMoreThanAVisit) {
  const PresenceGrid grid = small_place();
  std::vector<VisitFrame> frames(50, VisitFrame{{20.0, 0.0}, 10.0, {{{20.1, 1.1}}}});
  const SightOptions sight;
  std::vector<double> weight(grid.size(), 0.0);
  for (const PresenceObservation& z :
       observations_of(grid, gather_evidence(grid, frames, {}, sight), frames, sight))
    weight[static_cast<std::size_t>(z.node)] += z.weight;
  const double full = 0.25 / 0.25;
  for (const double w : weight) EXPECT_LE(w, full + 1e-12);
}

TEST(Visit, PeopleOffTheMapAreCountedAndBadOnesRefused) {
  const PresenceGrid grid = small_place();
  std::vector<VisitFrame> frames(1, VisitFrame{{20.0, 0.0}, 0.1, {{{20.0, 50.0}}, {{20.0, 1.0}}}});
  const VisitEvidence evidence = gather_evidence(grid, frames, {}, {});
  EXPECT_EQ(evidence.people, 1U);
  EXPECT_EQ(evidence.people_off_map, 1U);
  for (const SeenPerson& bad : std::vector<SeenPerson>{
           {{NAN, 0.0}}, {{20.0, 0.0}, -1.0}, {{20.0, 0.0}, 0.3, 1.5}, {{20.0, 0.0}, 0.3, NAN}}) {
    frames[0].people = {bad};
    EXPECT_THROW((void)gather_evidence(grid, frames, {}, {}), BadInput);
  }
}

TEST(Ages, EachItemIsStaleAfterItsOwnHalfLife) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  AgedLayers layers;
  layers.put({"lanes", 0, 0.0});
  layers.put({"wet ground", 0, 6.0 * 3600.0});
  layers.put({"road works", 0, 600.0});
  layers.put({"pedestrian 7", 0, 2.0});
  EXPECT_EQ(layers.find("lanes")->layer(), AgeLayer::kStatic);
  EXPECT_EQ(layers.find("wet ground")->layer(), AgeLayer::kSemiStatic);
  EXPECT_EQ(layers.find("road works")->layer(), AgeLayer::kSemiDynamic);
  EXPECT_EQ(layers.find("pedestrian 7")->layer(), AgeLayer::kDynamic);
  for (const AgedItem& item : layers.all()) {
    if (item.half_life_s == 0.0) {
      EXPECT_FALSE(item.stale(std::int64_t{1} << 62));
      continue;
    }
    const auto half = static_cast<std::int64_t>(item.half_life_s) * kSecond;
    EXPECT_FALSE(item.stale(half)) << item.name;
    EXPECT_TRUE(item.stale(half + 1)) << item.name;
    EXPECT_NEAR(item.weight(half), 0.5, 1e-12);
    EXPECT_NEAR(item.weight(3 * half), 0.125, 1e-12);
  }
  layers.put({"pedestrian 7", 5 * kSecond, 2.0});  // seen again
  EXPECT_FALSE(layers.find("pedestrian 7")->stale(6 * kSecond));
  EXPECT_EQ(layers.of(AgeLayer::kDynamic).size(), 1U);
  EXPECT_THROW(layers.put({"x", 0, -1.0}), InvalidOption);
}

TEST(Ages, TheLayersOfHalfLivesAreThoseOfAMinuteAnHourAndAWeek) {
  const auto layer = [](double half_life_s) { return AgedItem{"x", 0, half_life_s}.layer(); };
  for (const auto& [bound_s, within, beyond] :
       {std::tuple{60.0, AgeLayer::kDynamic, AgeLayer::kSemiDynamic},
        {3600.0, AgeLayer::kSemiDynamic, AgeLayer::kSemiStatic},
        {604'800.0, AgeLayer::kSemiStatic, AgeLayer::kStatic}}) {
    EXPECT_EQ(layer(bound_s), within) << bound_s;
    EXPECT_EQ(layer(bound_s + 1.0), beyond) << bound_s;
  }
}

// A look states its reach. Beyond the reach it gives no evidence, for any range in the options.
TEST(Visit, ALookTellsOfNothingBeyondItsReach) {
  const PresenceGrid grid = small_place();
  VisitFrame frame;
  frame.position = {10.0, 0.0};
  frame.duration_s = 0.5;
  frame.heading = 0.25 * M_PI;           // four sectors: ahead-left of it, and so on round
  frame.reach_m = {0.0, 6.0, 0.0, 3.0};  // backwards 6 m, forwards 3 m
  const VisitEvidence evidence = gather_evidence(grid, {frame}, {}, {});
  const auto seen = [&](double x, double y) {
    return evidence.seen_s[static_cast<std::size_t>(grid.node_at({x, y}).value())];
  };
  EXPECT_EQ(seen(12.3, 0.2), 0.5);
  EXPECT_EQ(seen(14.3, 0.2), 0.0);
  EXPECT_EQ(seen(5.3, 0.2), 0.5);
  EXPECT_EQ(seen(3.3, 0.2), 0.0);
  EXPECT_EQ(seen(10.3, 4.3), 0.0);
}

}  // namespace
}  // namespace roadbook
