#include "base/cell_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "base/random.hpp"

// Compares the grid with a search through all points.

namespace roadbook {
namespace {

template <int kAxes>
std::vector<Eigen::Matrix<double, kAxes, 1>> random_points(std::size_t count, Random& random) {
  std::vector<Eigen::Matrix<double, kAxes, 1>> points(count);
  for (auto& p : points)
    for (int k = 0; k < kAxes; ++k) p[k] = random.uniform(-10.0, 10.0);
  return points;
}

template <int kAxes>
void expect_all_near_in_order(double cell_m) {
  Random random(1, "cell grid");
  const auto points = random_points<kAxes>(500, random);
  CellGrid<std::size_t, kAxes> grid(cell_m);
  for (std::size_t i = 0; i < points.size(); ++i) grid.insert(points[i], i);
  for (const auto& place : random_points<kAxes>(200, random)) {
    std::vector<std::pair<GridCell<kAxes>, std::size_t>> visited;
    grid.visit_near(
        place, [&](std::size_t i) { visited.emplace_back(cell_at<kAxes>(points[i], cell_m), i); });
    EXPECT_TRUE(std::is_sorted(visited.begin(), visited.end()));
    std::vector<std::size_t> found;
    for (const auto& [cell, i] : visited)
      if ((points[i] - place).norm() <= cell_m) found.push_back(i);
    std::sort(found.begin(), found.end());
    std::vector<std::size_t> wanted;
    for (std::size_t i = 0; i < points.size(); ++i)
      if ((points[i] - place).norm() <= cell_m) wanted.push_back(i);
    EXPECT_EQ(found, wanted);
  }
}

TEST(CellGrid, VisitsAllPointsUpToASideAwayInOrderOfCells) {
  for (const double cell_m : {0.3, 1.0, 7.0}) {
    expect_all_near_in_order<2>(cell_m);
    expect_all_near_in_order<3>(cell_m);
  }
}

TEST(CellGrid, FindsTheValuesOfOneCellInOrderOfInsertion) {
  CellGrid<int> grid(2.0);
  grid.insert({-0.1, 0.1}, 7);
  grid.insert({-1.9, 1.9}, 3);
  grid.insert({0.1, 0.1}, 5);
  ASSERT_NE(grid.find({-1.0, 1.0}), nullptr);
  EXPECT_EQ(*grid.find({-1.0, 1.0}), (std::vector<int>{7, 3}));
  EXPECT_EQ(grid.find({-2.1, 1.0}), nullptr);
}

TEST(CellGrid, HasItsFirstCellAtTheOrigin) {
  EXPECT_EQ(cell_at<2>({0.0, 1.99}, 2.0), (GridCell<2>{0, 0}));
  EXPECT_EQ(cell_at<2>({-1e-9, 2.0}, 2.0), (GridCell<2>{-1, 1}));
}

}  // namespace
}  // namespace roadbook
