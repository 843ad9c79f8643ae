#include "exchange/layers/speed_layers.hpp"

#include <gtest/gtest.h>

#include "exchange/layers/friction_layers.hpp"
#include "tests/exchange/stored_speeds.hpp"

// Speed and friction maps stored and read back.

namespace roadbook {
namespace {

using test::Stored;

TEST(SpeedLayers, AFrictionMapReadsBackToTheSameNumbers) {
  const Stored stored;
  const auto read = read_friction_layers(MapLayers(stored.map), stored.place.paths);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->sessions, stored.friction.sessions);
  EXPECT_EQ(read->date_ns, stored.friction.date_ns);
  EXPECT_EQ(read->carry.dropped, 0U);
  Random random(2, "places");
  for (const LaneStrips::Strip& strip : stored.friction.strips.strips())
    for (int k = 0; k < 50; ++k) {
      const PathPlace v{strip.begin_m + random.uniform(0.0, strip.length_m()),
                        random.uniform(-2.0, 2.0)};
      const auto a = stored.friction.map.moments(0, v);
      const auto b = read->map.moments(0, v);
      ASSERT_TRUE(a && b);
      EXPECT_NEAR(a->mean, b->mean, 1e-12);
      EXPECT_NEAR(a->variance, b->variance, 1e-12);
    }
}

TEST(SpeedLayers, KnotsGoWithALaneThatHasMovedAndANewLaneStartsFresh) {
  const Stored stored;
  std::vector<LanePath> lanes = stored.place.paths;
  const std::uint64_t lost = lanes.back().lane;
  lanes.back().lane = 99;
  for (Eigen::Vector3d& p : lanes.front().path.points) p += Eigen::Vector3d(3.0, 1.0, 0.0);
  const auto read = read_friction_layers(MapLayers(stored.map), lanes);
  ASSERT_TRUE(read);
  EXPECT_GT(read->carry.dropped, 0U);
  EXPECT_EQ(read->strips.find(lost), nullptr);
  const double begin = read->strips.find(lanes.front().lane)->begin_m;
  const double old = stored.friction.strips.find(lanes.front().lane)->begin_m;
  EXPECT_NEAR(read->map.moments(0, {begin + 7.3, 0.6})->mean,
              stored.friction.map.moments(0, {old + 7.3, 0.6})->mean, 1e-9);
  EXPECT_EQ(read->map.evidence({read->strips.find(99)->begin_m + 5.0, 0.0}), 0.0);
}

TEST(SpeedLayers, ASpeedMapReadsBack) {
  const Stored stored;
  const auto read = read_speed_layers(MapLayers(stored.map));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->sessions, stored.speeds.sessions);
  EXPECT_EQ(read->options.max_speed, 12.0);
  ASSERT_EQ(read->cells.size(), stored.speeds.cells.size());
  EXPECT_NEAR(read->coverage(), 0.5, 0.01);
  ASSERT_EQ(read->profiles.size(), stored.speeds.profiles.size());
  for (std::size_t i = 0; i < read->profiles.size(); ++i)
    for (double s = 0.0; s < 20.0; s += 0.7)
      EXPECT_NEAR(read->profiles[i].speed_at(s), stored.speeds.profiles[i].speed_at(s), 1e-12);
  const PlainTable ages = MapLayers(stored.map).read_table("layer_ages");
  EXPECT_EQ(std::get<std::string>(ages.rows.at(0).at(0)), "lanes");
  EXPECT_EQ(std::get<std::string>(ages.rows.at(1).at(1)), "dynamic");
  EXPECT_EQ(std::get<std::int64_t>(ages.rows.at(1).at(5)), 1) << "older than its half-life";
}

}  // namespace
}  // namespace roadbook
