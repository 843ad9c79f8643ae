#include <gtest/gtest.h>

#include <cmath>

#include "apps/evaluation/speed_evolution.hpp"
#include "speedmap/experiments/wet_patch_study.hpp"
#include "tests/apps/driven_road.hpp"
#include "tests/exchange/driven_place.hpp"
#include "workflows/speeds_update.hpp"

namespace roadbook {
namespace {

// [Metric-semantic maps, figure 10]: the first visit meets no person. People are on the right
// crossing in revisits 1 to 3 and on the left crossing in revisits 4 to 6.
TEST(Speeds, DangerRisesOnTheRightCrossingFirstAndOnTheLeftOneThen) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const SpeedEvolution e = zurich_evolution({}, {}, seed);
    ASSERT_EQ(e.right.size(), 7U);
    EXPECT_TRUE(e.people[0].empty());
    EXPECT_GT(e.people[1].size(), 20U);
    EXPECT_GT(e.right[3], 2.0 * e.right[0]);
    EXPECT_GT(e.right[3], 4.0 * e.left[3]);
    for (std::size_t map = 1; map < 4; ++map) EXPECT_GT(e.right[map], e.right[map - 1]);
    for (std::size_t map = 4; map < 7; ++map) EXPECT_GT(e.left[map], e.left[map - 1]);
    EXPECT_GT(e.left[6], 3.0 * e.left[3]);
    EXPECT_LT(e.right[6], e.right[3]) << "seen empty three times";
    for (const double lane : e.lanes) EXPECT_LT(lane, 0.1);
  }
}

TEST(Speeds, APatchThatWasOnlySeenIsRarelyDrivenTooFast) {
  WetPatchOptions options;
  options.cases = 100;
  const WetPatchResult careful = wet_patch_study(options);
  EXPECT_LT(careful.above_grip, 5);
  EXPECT_EQ(careful.beyond_circle, 0);
  EXPECT_GT(careful.mean_speed, 0.6 * careful.mean_speed_known);
  options.quantile = 0.5;
  EXPECT_GT(wet_patch_study(options).above_grip, 2 * careful.above_grip + 5) << "the mean alone";
}

// Six visits without people happen with probability (1 - p)^6, where a single visit meets people
// with probability p.
TEST(Speeds, CalmIsDeclaredAsRarelyAsChanceHasIt) {
  const double p = 0.4;
  const double calm = false_calm(p, 0.3, 0.1, 6, 20000, 1);
  EXPECT_LT(calm, 0.05);
  EXPECT_NEAR(calm, std::pow(1.0 - p, 6), 4.0 * std::sqrt(0.0467 / 20000.0));
}

// A planner may use the speeds of the map's cells and not a profile. Its speed in a bend must not
// exceed the limit of that bend either.
TEST(Speeds, CellsOfALaneAreNoFasterThanItsBends) {
  const test::DrivenPlace place;
  SpeedSources sources;
  sources.network = place.network;
  sources.paths = place.paths;
  std::vector<VisitSummary> visits;
  const SpeedsConfig config;
  const SpeedMap speeds =
      make_speed_map(test::driven_road(), std::move(sources), config, 0, visits);
  int slowed = 0;
  for (const LanePath& path : place.paths) {
    const PathCurve curve(path.path);
    for (double s = 1.0; s < curve.length_m() - 1.0; s += 0.5) {
      const PathPoint at = curve.at(s);
      for (const SpeedCell& cell : speeds.cells) {
        if ((cell.centre - at.position).norm() > 0.2) continue;
        // The curvature changes along a cell. The smallest curvature near the cell gives the bound.
        double gentlest = INFINITY;
        for (double d = -0.6; d <= 0.6; d += 0.1)
          gentlest = std::min(gentlest, std::abs(curve.at(s + d).curvature));
        EXPECT_LE(cell.speed, std::sqrt(config.speed.motion.lateral / gentlest) + 1e-6) << s;
        slowed += cell.speed < 0.9 * config.speed.max_speed ? 1 : 0;
      }
    }
  }
  EXPECT_GT(slowed, 10);
}

}  // namespace
}  // namespace roadbook
