#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>

#include "apps/evaluation/occupancy/grid_rules.hpp"
#include "apps/evaluation/occupancy/intel_study.hpp"
#include "base/random.hpp"
#include "tests/apps/run_command.hpp"

namespace roadbook {
namespace {

// One beam along x, read twice at 1 m: the last cell is hit, the cells before it are missed.
TEST(GridRules, ABeamOfTheHandSetRuleCountsInEachCellThatItCrosses) {
  RangeScan scan;
  scan.origin = {0.05, 0.05};
  scan.beams = {{0, Eigen::Vector2f::UnitX(), 1.0}};
  const RuledGrid ruled = grid_by_rule({scan, scan}, GridRule::kHandSet, {});
  const OccupancyGrid& grid = ruled.grid;
  const double hit = 2.0 * std::log(0.55 / 0.45);
  const double miss = 2.0 * std::log(0.49 / 0.51);
  std::size_t hits = 0;
  std::size_t misses = 0;
  for (std::size_t i = 0; i < grid.seen.size(); ++i) {
    if (grid.change[i] == 0.0F) {
      EXPECT_EQ(grid.seen[i], 0U);
      continue;
    }
    EXPECT_EQ(grid.seen[i], 2U);
    EXPECT_EQ(grid.effective[i], 2.0F);
    EXPECT_NEAR(grid.change[i], grid.change[i] > 0.0F ? hit : miss, 1e-5);
    ++(grid.change[i] > 0.0F ? hits : misses);
  }
  EXPECT_EQ(hits, 1U);
  EXPECT_EQ(misses, 10U);
}

// Distance to the walls of a square room of 12 m around the origin.
double to_wall(const Eigen::Vector2d& from, double angle) {
  double least = std::numeric_limits<double>::infinity();
  const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
  for (int axis = 0; axis < 2; ++axis)
    if (std::abs(along[axis]) > 1e-9)
      least = std::min(least, (std::copysign(6.0, along[axis]) - from[axis]) / along[axis]);
  return least;
}

// A table as of the Intel lab, of exact ranges in a room: walls are as thin as the ranges, and
// thicker by poses that are wrong.
TEST(IntelStudy, WallsAreThinByRightPosesAndThickByWrongOnes) {
  const test::ScratchFolder folder;
  const auto table = folder.path() / "intel_scans.csv";
  std::ofstream file(table);
  file << "head\n";
  Random random(3, "room");
  for (int i = 0; i < 60; ++i) {
    const Eigen::Vector2d at(random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0));
    const double heading = random.uniform(-3.0, 3.0);
    file << 976000000 + i;
    file << ',' << at.x() + 0.2 * random.normal() << ',' << at.y() + 0.2 * random.normal() << ','
         << heading << ',' << at.x() << ',' << at.y() << ',' << heading;
    for (int beam = 0; beam < 180; ++beam) {
      const double angle = heading + (beam - 90) * std::numbers::pi / 180.0;
      file << ',' << to_wall(at, angle) + 0.01 * random.normal();
    }
    file << '\n';
  }
  file.close();
  const IntelStudy study = study_intel(table, folder.path());
  EXPECT_EQ(study.scans, 60U);
  EXPECT_LT(study.thickness_corrected_m, 0.05);
  EXPECT_GT(study.thickness_raw_m, 0.3);
}

}  // namespace
}  // namespace roadbook
