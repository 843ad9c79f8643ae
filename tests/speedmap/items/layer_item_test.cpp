#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "speedmap/items/item_effects.hpp"

namespace roadbook {
namespace {

constexpr std::int64_t kNow = 1'700'000'000'000'000'000;
constexpr std::int64_t kSecond = 1'000'000'000;

LayerItem item_of(const std::string& kind, ItemShape shape, std::vector<Eigen::Vector2d> part) {
  LayerItem item;
  item.kind = kind;
  item.shape = shape;
  item.parts = {std::move(part)};
  item.half_life_s = find_item_kind(kind)->half_life_s;
  item.observed_ns = kNow;
  return item;
}

TEST(LayerItems, EveryAgeOfTheDocumentHasAKind) {
  std::map<AgeLayer, int> count;
  for (const ItemKind& kind : item_kinds())
    ++count[AgedItem{kind.name, kNow, kind.half_life_s}.layer()];
  for (const AgeLayer layer :
       {AgeLayer::kStatic, AgeLayer::kSemiStatic, AgeLayer::kSemiDynamic, AgeLayer::kDynamic})
    EXPECT_GT(count[layer], 0) << to_text(layer);
  EXPECT_EQ(find_item_kind("road works"), nullptr);
}

TEST(LayerItems, AnItemIsUsedFromItsObservationUntilItsHalfLifeOrItsMark) {
  LayerItem item = item_of("queue", ItemShape::kPoint, {{0.0, 0.0}});
  EXPECT_EQ(item.state(kNow - 1), ItemState::kLater);
  EXPECT_EQ(item.state(kNow), ItemState::kUsed);
  EXPECT_EQ(item.state(kNow + 599 * kSecond), ItemState::kUsed);
  EXPECT_NEAR(item.weight(kNow + 300 * kSecond), std::exp2(-0.5), 1e-12);
  EXPECT_EQ(item.state(kNow + 601 * kSecond), ItemState::kStale);
  item.expired_ns = kNow + 60 * kSecond;
  EXPECT_EQ(item.state(kNow + 59 * kSecond), ItemState::kUsed);
  EXPECT_EQ(item.state(kNow + 60 * kSecond), ItemState::kExpired);
  item.recorded_ns = kNow + 5;
  EXPECT_EQ(time_of_items({item}, kNow), kNow + 60 * kSecond);
  EXPECT_EQ(time_of_items({}, kNow), kNow);
}

TEST(LayerItems, DistancesOfPointsLinesAndPolygonsWithHoles) {
  EXPECT_NEAR(item_of("vehicle", ItemShape::kPoint, {{3, 4}}).distance_m({0, 0}), 5.0, 1e-12);
  const LayerItem line = item_of("queue", ItemShape::kLine, {{0, 0}, {10, 0}, {10, 10}});
  EXPECT_NEAR(line.distance_m({5, -2}), 2.0, 1e-12);
  EXPECT_NEAR(line.distance_m({5, 5}), 5.0, 1e-12) << "a line does not close";
  LayerItem area = item_of("weather", ItemShape::kPolygon, {{0, 0}, {10, 0}, {10, 10}, {0, 10}});
  area.parts.push_back({{4, 4}, {6, 4}, {6, 6}, {4, 6}});
  EXPECT_EQ(area.distance_m({2, 2}), 0.0);
  EXPECT_NEAR(area.distance_m({5, 5}), 1.0, 1e-12) << "in the hole";
  EXPECT_NEAR(area.distance_m({-3, 5}), 3.0, 1e-12) << "the ring closes";
}

// A straight lane of 60 m at 8 m/s on friction of mean 0.8.
LaneProfile straight_lane(const LaneSpeedOptions& options) {
  LaneProfile profile;
  profile.step_m = 0.25;
  std::vector<WayPoint> way;
  std::vector<double> s;
  for (int i = 0; i <= 240; ++i) {
    s.push_back(0.25 * i);
    way.push_back({{0.25 * i, 0.0}, {0.0, 1.0}, 0.0});
  }
  const FrictionAt friction = [](double, double) {
    return std::optional(PropertyMoments{0.8, 0.0025});
  };
  profile.places = speed_limits_along(way, s, 8.0, {}, friction, options);
  make_feasible(profile.places, profile.step_m, false, options);
  return profile;
}

double speed_with(const LayerItem& item, std::int64_t now, double s, SpeedLimitedBy* by = nullptr) {
  const LaneSpeedOptions options;
  std::vector<LaneProfile> profiles{straight_lane(options)};
  apply_items(profiles, ItemEffects({item}, now, options), options);
  const auto& place = profiles[0].places[static_cast<std::size_t>(s / 0.25)];
  if (by != nullptr) *by = place.limited_by();
  return place.speed;
}

TEST(LayerItems, TheWeightScalesWhatAnItemTakesFromTheSpeed) {
  LayerItem works = item_of("road_works", ItemShape::kLine, {{42, 0}, {50, 0}});
  works.reach_m = 5.0;
  works.speed = 3.0;
  const double without = straight_lane({}).speed_at(45.0);
  EXPECT_NEAR(without, 8.0, 1e-9);
  SpeedLimitedBy by{};
  EXPECT_NEAR(speed_with(works, kNow, 45.0, &by), 3.0, 1e-9);
  EXPECT_EQ(by, SpeedLimitedBy::kItem);
  const std::int64_t half = kNow + 1800 * kSecond;
  const double w = works.weight(half);
  EXPECT_NEAR(speed_with(works, half, 45.0), w * 3.0 + (1.0 - w) * 8.0, 1e-9);
  EXPECT_NEAR(speed_with(works, kNow + 3601 * kSecond, 45.0), 8.0, 1e-9) << "stale";
  EXPECT_NEAR(speed_with(works, kNow - kSecond, 45.0), 8.0, 1e-9) << "not yet observed";
  EXPECT_NEAR(speed_with(works, kNow, 0.0), 8.0, 1e-9) << "far away";
  EXPECT_LT(speed_with(works, kNow, 34.0), 8.0) << "the vehicle brakes before the works";
  works.speed.reset();
  EXPECT_NEAR(speed_with(works, kNow, 45.0), LaneSpeedOptions{}.min_speed, 1e-9);
  works.speed = 20.0;
  EXPECT_NEAR(speed_with(works, kNow, 45.0), 8.0, 1e-9) << "an item raises no speed";
}

TEST(LayerItems, WetGroundLowersFrictionByItsFactorAndWeight) {
  LayerItem rain = item_of("weather", ItemShape::kPolygon, {{0, -9}, {60, -9}, {60, 9}, {0, 9}});
  rain.grip_factor = 0.1;
  const LaneSpeedOptions options;
  const double quantile = grip_speed_of({0.8, 0.0025}, 0.0, options).friction;
  const double wet = grip_speed(0.1 * quantile, 0.0, options);
  ASSERT_LT(wet, 8.0);
  SpeedLimitedBy by{};
  EXPECT_NEAR(speed_with(rain, kNow, 30.0, &by), wet, 1e-9);
  EXPECT_EQ(by, SpeedLimitedBy::kItem);
  const double w = rain.weight(kNow + 900 * kSecond);
  EXPECT_NEAR(speed_with(rain, kNow + 900 * kSecond, 30.0),
              grip_speed((1.0 - w * 0.9) * quantile, 0.0, options), 1e-9);
  rain.grip_factor = 1.0;
  EXPECT_NEAR(speed_with(rain, kNow, 30.0), 8.0, 1e-9);
}

}  // namespace
}  // namespace roadbook
