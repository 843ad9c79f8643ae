#include "roadnet/sparse_tracks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/random.hpp"
#include "tests/roadnet/chicago.hpp"
#include "tests/roadnet/random_city.hpp"
#include "tests/support/real_data.hpp"

namespace roadbook {
namespace {

constexpr double kNear_m = 20.0;

std::vector<test::Track> lines_of(const RoadNetwork& network) {
  std::vector<test::Track> lines;
  for (const Lane& lane : network.lanes) {
    lines.emplace_back();
    for (const Eigen::Vector3d& p : lane.centre) lines.back().push_back(p.head<2>());
  }
  return lines;
}

/// Drives along corners that are joined by straight streets, every second one backwards: a position
/// every `step_m`, the first anywhere in the first step, each wrong by `noise_m` in x and in y.
std::vector<DrivenPass> drives_along(
    const test::Track& corners, int count, double step_m, double noise_m, std::uint64_t seed) {
  Random random(seed, "drives");
  std::vector<DrivenPass> passes;
  for (int d = 0; d < count; ++d) {
    DrivenPass pass;
    double next_m = step_m * random.uniform();
    for (std::size_t c = 0; c + 1 < corners.size(); ++c) {
      const Eigen::Vector2d way = corners[c + 1] - corners[c];
      for (; next_m < way.norm(); next_m += step_m) {
        const Eigen::Vector2d at = corners[c] + way.normalized() * next_m;
        pass.positions.emplace_back(at.x() + noise_m * random.normal(),
                                    at.y() + noise_m * random.normal(), 0.0);
      }
      next_m -= way.norm();
    }
    if (d % 2 == 1) std::reverse(pass.positions.begin(), pass.positions.end());
    passes.push_back(std::move(pass));
  }
  return passes;
}

double distance_to(const test::Track& line, const Eigen::Vector2d& p) {
  double least = 1e9;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Eigen::Vector2d d = line[i + 1] - line[i];
    const double share = std::clamp((p - line[i]).dot(d) / d.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (line[i] + share * d - p).norm());
  }
  return least;
}

// 20 drives of 8 positions each: about 8 positions a window of 100 m, so that the middle is known
// to 10 / sqrt(8) = 3.5 m; three times that is allowed.
TEST(SparseTracks, AStraightStreetIsOneLaneAtItsMiddle) {
  const test::Track street{{0.0, 0.0}, {2000.0, 0.0}};
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const RoadNetwork network = build_road_network(drives_along(street, 20, 250.0, 10.0, seed),
                                                   RoadNetworkOptions::for_gps());
    ASSERT_EQ(network.lanes.size(), 1U);
    EXPECT_GT(network.length_m, 1750.0);
    EXPECT_LT(network.length_m, 2050.0);
    for (const Eigen::Vector3d& p : network.lanes[0].centre) EXPECT_LT(std::abs(p.y()), 10.5);
    EXPECT_GT(network.coverage, 0.95);
  }
}

// Every drive alone cuts the corner: a chord of 250 m passes up to 88 m from it. Only the positions
// of the other drives show where the road turns. A hop of three reaches, which costs twice its
// length, cuts 17 m off the corner; drawing the ways together may cut one reach more.
TEST(SparseTracks, ACornerThatEveryDriveCutsIsFoundFromAllOfThem) {
  const test::Track road{{0.0, 0.0}, {1000.0, 0.0}, {1000.0, 1000.0}};
  const double reach_m = RoadNetworkOptions::for_gps().reach_m;
  const double noise_m = 5.0;
  const double allowed_m = 3.0 * reach_m / std::sqrt(8.0) + reach_m + noise_m;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const RoadNetwork network = build_road_network(drives_along(road, 30, 250.0, noise_m, seed),
                                                   RoadNetworkOptions::for_gps());
    double from_corner_m = 1e9;
    for (const test::Track& line : lines_of(network)) {
      from_corner_m = std::min(from_corner_m, distance_to(line, {1000.0, 0.0}));
      for (const Eigen::Vector2d& p : line) EXPECT_LT(distance_to(road, p), allowed_m);
    }
    EXPECT_LT(from_corner_m, allowed_m);
  }
}

struct CityCase {
  double interval_s;
  double noise_m;
  double recall;  ///< wanted at that interval
};

class SparseCity : public testing::TestWithParam<CityCase> {};

TEST_P(SparseCity, StreetsDrivenThreeTimesAreFoundAndFewThatAreNone) {
  const test::CityTracks tracks = test::drive_through(
      {.noise_m = GetParam().noise_m, .interval_s = GetParam().interval_s, .seed = 1});
  const RoadNetwork network = build_road_network(tracks.passes, RoadNetworkOptions::for_gps());
  const auto score = score_streets(lines_of(network), tracks.map, tracks.driven, 3, kNear_m);
  EXPECT_GE(score.precision, 0.9);
  EXPECT_GE(score.recall, GetParam().recall);
}

INSTANTIATE_TEST_SUITE_P(IntervalAndNoise,
                         SparseCity,
                         testing::Values(CityCase{10.0, 5.0, 0.85},
                                         CityCase{10.0, 20.0, 0.85},
                                         CityCase{20.0, 10.0, 0.8},
                                         CityCase{30.0, 5.0, 0.7},
                                         CityCase{30.0, 10.0, 0.7}),
                         [](const auto& city) {
                           return std::to_string(static_cast<int>(city.param.interval_s)) + "s" +
                                  std::to_string(static_cast<int>(city.param.noise_m)) + "m";
                         });

TEST(SparseTracks, TheSameTracksGiveTheSameNetwork) {
  const test::CityTracks tracks = test::drive_through({.drives = 60});
  const auto options = RoadNetworkOptions::for_gps();
  const RoadNetwork a = build_road_network(tracks.passes, options);
  const RoadNetwork b = build_road_network(tracks.passes, options);
  ASSERT_EQ(a.lanes.size(), b.lanes.size());
  for (std::size_t l = 0; l < a.lanes.size(); ++l) {
    EXPECT_EQ(a.lanes[l].id, b.lanes[l].id);
    EXPECT_EQ(a.lanes[l].centre, b.lanes[l].centre);
  }
}

TEST(SparseTracks, PositionsCloserThanThreeReachesAreNotSparse) {
  const test::Track street{{0.0, 0.0}, {2000.0, 0.0}};
  const auto options = RoadNetworkOptions::for_gps();
  EXPECT_FALSE(is_sparse(drives_along(street, 3, 40.0, 0.0, 1), options, options.reach_m));
  EXPECT_TRUE(is_sparse(drives_along(street, 3, 60.0, 0.0, 1), options, options.reach_m));
  EXPECT_FALSE(is_sparse({}, options, options.reach_m));
  // Poses of a camera drive: straight between two of them, whatever their distance.
  EXPECT_FALSE(is_sparse(drives_along(street, 3, 60.0, 0.0, 1), {}, 3.0));
}

TEST(SparseTracks, ALongGapIsNotFilledButNamed) {
  const test::Track west{{0.0, 0.0}, {1500.0, 0.0}};
  auto passes = drives_along(west, 10, 100.0, 3.0, 1);
  for (DrivenPass& pass : passes) {  // and 3 km farther east, without a position between
    const std::size_t count = pass.positions.size();
    if (pass.positions.front().x() > pass.positions.back().x())
      std::reverse(pass.positions.begin(), pass.positions.end());
    for (std::size_t i = 0; i < count; ++i)
      pass.positions.push_back(pass.positions[i] + Eigen::Vector3d(4500.0, 0.0, 0.0));
  }
  const RoadNetwork network = build_road_network(passes, RoadNetworkOptions::for_gps());
  for (const test::Track& line : lines_of(network))
    for (const Eigen::Vector2d& p : line) EXPECT_TRUE(p.x() < 1600.0 || p.x() > 4400.0);
  EXPECT_EQ(network.status, RoadNetworkStatus::kLowCoverage);
  ASSERT_FALSE(network.uncovered.empty());
  const UncoveredStretch& most = network.uncovered.front();
  EXPECT_LT(std::min(most.from.x(), most.to.x()), 1700.0);
  EXPECT_GT(std::max(most.from.x(), most.to.x()), 4300.0);
  EXPECT_NEAR(most.driven_m, 10 * 3000.0, 10 * 300.0);
}

// The whole set at all intervals and phases: sparse_tracks_study.
TEST(SparseTracks, ChicagoIsFoundFromOnePositionInHalfAMinute) {
  ROADBOOK_REQUIRE_DATA(folder, "road_tracks");
  const auto trips = test::chicago_trips(folder);
  ASSERT_GT(trips.size(), 800U);
  const test::StreetMap map = test::chicago_streets(folder);
  std::vector<test::TimedTrack> some;  // every third trip: enough, and quick
  for (std::size_t t = 0; t < trips.size(); t += 3) some.push_back(trips[t]);
  const auto driven = driven_times(map, test::positions_of(some));
  const RoadNetwork network = build_road_network(test::passes_of(test::thinned(some, 30.0, 10.0)),
                                                 RoadNetworkOptions::for_gps());
  const auto score = score_streets(lines_of(network), map, driven, 3, kNear_m);
  EXPECT_GE(score.precision, 0.9);
  EXPECT_GE(score.recall, 0.7);
  EXPECT_GT(network.coverage, 0.95);
}

}  // namespace
}  // namespace roadbook
