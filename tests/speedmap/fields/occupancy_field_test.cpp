#include "speedmap/fields/occupancy_field.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.hpp"
#include "base/random.hpp"

namespace roadbook {
namespace {

// A grid of random probabilities with a hole and an unknown rim.
OccupancyCells random_cells() {
  OccupancyCells cells;
  cells.low = {-3.0, 7.0};
  cells.cell_m = 0.1;
  cells.columns = 40;
  cells.rows = 30;
  Random random(3, "cells");
  for (int r = 0; r < cells.rows; ++r)
    for (int c = 0; c < cells.columns; ++c) {
      const bool unknown = c < 3 || r > 26 || (c > 15 && c < 22 && r > 10 && r < 15);
      cells.probability.push_back(unknown ? NAN : static_cast<float>(random.uniform(0.001, 0.999)));
      cells.sigma.push_back(unknown ? NAN : static_cast<float>(random.uniform(0.01, 0.2)));
      cells.age_s.push_back(unknown ? NAN : static_cast<float>(random.uniform(0.0, 100.0)));
    }
  return cells;
}

TEST(OccupancyField, EqualsTheGridAtTheMiddleOfACellAndIsUnknownWhereTheGridIs) {
  const OccupancyCells cells = random_cells();
  const OccupancyField field(cells);
  int known = 0;
  for (int r = 0; r < cells.rows; ++r)
    for (int c = 0; c < cells.columns; ++c) {
      const auto i = static_cast<std::size_t>(r * cells.columns + c);
      const auto at = field.at(cells.low + 0.1 * Eigen::Vector2d(c + 0.5, r + 0.5));
      ASSERT_EQ(at.has_value(), !std::isnan(cells.probability[i])) << c << " " << r;
      if (!at) continue;
      ++known;
      EXPECT_NEAR(at->probability, static_cast<double>(cells.probability[i]), 1e-6);
      EXPECT_EQ(at->sigma, static_cast<double>(cells.sigma[i]));
      EXPECT_EQ(at->age_s, static_cast<double>(cells.age_s[i]));
    }
  EXPECT_GT(known, 900);
  EXPECT_FALSE(field.at({-3.01, 8.0}));
  EXPECT_FALSE(field.at({1.01, 8.0}));
  EXPECT_FALSE(field.at({NAN, 8.0}));
}

TEST(OccupancyField, GradientsAgreeWithDifferences) {
  const OccupancyCells cells = random_cells();
  const OccupancyField field(cells);
  Random random(4, "places");
  constexpr double kStep = 2e-6;  // its square leaves 1e-7 of the third derivative
  int compared = 0;
  for (int k = 0; k < 5000; ++k) {
    const Eigen::Vector2d p =
        cells.low + Eigen::Vector2d(random.uniform(0.0, 4.0), random.uniform(0.0, 3.0));
    const auto at = field.at(p);
    if (!at) continue;
    for (int axis = 0; axis < 2; ++axis) {
      // The second derivative jumps at the middles of cells.
      const double share = 10.0 * (p - cells.low)[axis] - 0.5;
      if (std::abs(share - std::round(share)) < 1e-3) continue;
      Eigen::Vector2d d = Eigen::Vector2d::Zero();
      d[axis] = kStep;
      const auto up = field.at(p + d), down = field.at(p - d);
      if (!up || !down) continue;
      EXPECT_NEAR((up->probability - down->probability) / (2.0 * kStep), at->gradient[axis], 1e-6);
      ++compared;
    }
  }
  EXPECT_GT(compared, 5000);
}

// An unknown neighbour must not pull the value towards free, occupied or the prior.
TEST(OccupancyField, UnknownNeighboursAddNoBelief) {
  OccupancyCells cells;
  cells.columns = cells.rows = 6;
  cells.cell_m = 1.0;
  cells.probability.assign(36, NAN);
  cells.sigma = cells.age_s = cells.probability;
  for (const int i : {14, 15, 20, 21}) cells.probability[static_cast<std::size_t>(i)] = 0.9F;
  const OccupancyField field(cells);
  for (double x = 2.0; x < 4.0; x += 0.1)
    EXPECT_NEAR(field.at({x, 2.7})->probability, 0.9, 1e-6) << x;
}

TEST(OccupancyField, RefusesSizesThatContradictAndNoProbabilities) {
  OccupancyCells cells = random_cells();
  cells.sigma.pop_back();
  EXPECT_THROW(OccupancyField{cells}, InvalidOption);
  cells = random_cells();
  cells.probability[200] = 1.5F;
  EXPECT_THROW(OccupancyField{cells}, InvalidOption);
}

}  // namespace
}  // namespace roadbook
