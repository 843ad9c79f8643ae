#include "mapping/occupancy/camera_evidence.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"
#include "mapping/occupancy/place_patches.hpp"

namespace roadbook {
namespace {

CameraSight low_sight(int landmark, const Eigen::Vector2d& p, const Eigen::Vector2d& low) {
  return {landmark, 0, false, p, low, Eigen::Matrix2d::Zero()};
}

TEST(SightRates, AreFoundFromTheCountsOfCellsWhoseKindIsHidden) {
  const double raised_if_occupied = 0.85, raised_if_free = 0.04, occupied = 0.15;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Random random(seed, "sights");
    std::vector<CellSights> cells(4000);
    for (CellSights& cell : cells) {
      const double rate = random.uniform() < occupied ? raised_if_occupied : raised_if_free;
      const int sights = 1 + static_cast<int>(8.0 * random.uniform());
      for (int i = 0; i < sights; ++i) (random.uniform() < rate ? cell.raised : cell.low) += 1.0;
    }
    const auto rates = fit_sight_rates(cells);
    ASSERT_TRUE(rates);
    // About 2,700 sights of occupied and 15,300 of free cells: standard errors 0.007 and 0.0016
    // with known kinds; four of them, a half more for the hidden kinds.
    EXPECT_NEAR(rates->raised_if_occupied, raised_if_occupied, 0.042);
    EXPECT_NEAR(rates->raised_if_free, raised_if_free, 0.01);
    EXPECT_NEAR(rates->occupied, occupied, 0.035);
    EXPECT_NEAR(rates->dispersion, 1.0, 0.1);
    EXPECT_GT(rates->temper(), 0.9);
  }
}

TEST(SightRates, RepeatedSightsCountForLess) {
  Random random(1, "repeated sights");
  std::vector<CellSights> cells(4000);
  for (CellSights& cell : cells) {
    const double rate = random.uniform() < 0.15 ? 0.85 : 0.04;
    // Each sight is counted four times: four times the variance, a quarter of the information.
    for (int i = 0; i < 5; ++i) (random.uniform() < rate ? cell.raised : cell.low) += 4.0;
  }
  const auto rates = fit_sight_rates(cells);
  ASSERT_TRUE(rates);
  EXPECT_NEAR(rates->dispersion, 4.0, 0.4);
  EXPECT_NEAR(rates->temper(), (20.0 / 4.0 - 1.0) / 19.0, 0.05);
}

TEST(SightRates, OneKindOfSightAloneSaysNothing) {
  EXPECT_FALSE(fit_sight_rates(std::vector<CellSights>{{0.0, 5.0}, {0.0, 2.0}}));
  EXPECT_FALSE(fit_sight_rates(std::vector<CellSights>{{3.0, 0.0}}));
  EXPECT_FALSE(fit_sight_rates({}));
}

TEST(CameraPatches, GroundIsFreeWhereTheSightIsLowAndOccupiedUnderARaisedLandmark) {
  std::vector<CameraSight> sights;
  int landmark = 0;
  // Lines of sight along x from 1.05 m to 2.05 m, on rows 0 to 9; a wall in column 30.
  for (int row = 0; row < 10; ++row)
    for (int n = 0; n < 6; ++n)
      sights.push_back(low_sight(landmark++, {2.05, 0.1 * row + 0.05}, {1.05, 0.1 * row + 0.05}));
  for (int row = 0; row < 10; ++row)
    for (int n = 0; n < 3; ++n)
      sights.push_back({landmark++,
                        0,
                        true,
                        {3.05, 0.1 * row + 0.05},
                        {0.0, 0.0},
                        Eigen::Matrix2d::Identity() * 1e-6});
  // The same landmark again, in another view, adds nothing.
  sights.push_back(sights.back());
  sights.back().view = 1;
  const std::vector<SightKeyframe> views{{10, {0.0, 0.0}, 0}, {20, {0.5, 0.0}, 1}};
  const std::vector<PatchAnchor> anchors{{"drive", 10, {}}, {"drive", 20, {0.5, 0.0, 0.3}}};
  const auto result = build_camera_patches(views, sights, anchors, "drive", {});
  ASSERT_TRUE(result);
  ASSERT_EQ(result->built.patches.size(), 1U);
  std::vector<OccupancyPatch> patches = result->built.patches;
  EXPECT_EQ(patches[0].t_ns, 20);
  const OccupancyGrid grid =
      place_patches(patches,
                    [&](const std::string&, std::int64_t t_ns) {
                      return std::optional(anchors[t_ns == 10 ? 0 : 1].map_vehicle);
                    },
                    {});
  EXPECT_EQ(grid.moved, 0U);
  const auto cell = [&](int column, int row) {
    const Eigen::Vector2d p =
        (Eigen::Vector2d(0.1 * column + 0.05, 0.1 * row + 0.05) - grid.shape.low) / 0.1;
    return grid.shape.index(static_cast<int>(std::floor(p.x())),
                            static_cast<int>(std::floor(p.y())));
  };
  const double prior = std::log(result->rates.occupied / (1.0 - result->rates.occupied));
  for (int row = 0; row < 10; ++row) {
    for (int column = 10; column <= 20; ++column) {
      EXPECT_EQ(grid.seen[cell(column, row)], 6U);
      EXPECT_TRUE(is_free(grid.probability(cell(column, row), prior),
                          grid.sigma(cell(column, row), prior)));
    }
    for (int column = 21; column < 30; ++column) EXPECT_EQ(grid.seen[cell(column, row)], 0U);
    EXPECT_EQ(grid.seen[cell(30, row)], 3U);
    EXPECT_EQ(grid.hits[cell(30, row)], 3U);
    EXPECT_GT(grid.probability(cell(30, row), prior), kOccupiedProbability);
  }
}

TEST(CameraPatches, AnUncertainLandmarkIsSharedAmongItsCells) {
  std::vector<CameraSight> sights{low_sight(0, {5.05, 0.05}, {4.05, 0.05})};
  Eigen::Matrix2d covariance;
  covariance << 0.04, 0.0, 0.0, 1e-6;  // 0.2 m along x
  sights.push_back({1, 0, true, {1.05, 0.05}, {0.0, 0.0}, covariance});
  const std::vector<SightKeyframe> views{{10, {0.0, 0.0}, 0}};
  const auto result = build_camera_patches(views, sights, {{"drive", 10, {}}}, "drive", {});
  ASSERT_TRUE(result);
  // Less than half of the landmark is in any cell: no cell becomes known by it.
  ASSERT_EQ(result->built.patches.size(), 1U);
  EXPECT_EQ(result->built.patches[0].columns, 11);
}

}  // namespace
}  // namespace roadbook
