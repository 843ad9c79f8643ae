#include "exchange/import/outline_shape.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace roadbook {
namespace {

TEST(OutlineShapes, TheStepOfDecimalsIsFound) {
  EXPECT_EQ(rounding_step({1028.0, 249.99999999999977}), 1.0);
  EXPECT_EQ(rounding_step({1028.5, 3.0}), 0.1);
  EXPECT_EQ(rounding_step({8.5418135, 47.376871}), 1e-7);
  const double single = static_cast<double>(1196.54716F);
  EXPECT_NEAR(rounding_step({single, 0.5}), std::pow(2.0, -13.0), 1e-12);  // 24 bits up to 2048
  EXPECT_EQ(rounding_step({1196.5471621825359}), 0.0);
  EXPECT_EQ(rounding_step({}), 0.0);
}

TEST(OutlineShapes, OverlapAndDistanceAreTheOnesWorkedByHand) {
  const std::vector<Eigen::Vector2d> a{{0, 0}, {2, 0}, {2, 1}, {0, 1}};
  const std::vector<Eigen::Vector2d> b{{1, 0}, {3, 0}, {3, 1}, {1, 1}};
  EXPECT_NEAR(intersection_over_union(a, b), 1.0 / 3.0, 1e-12);
  EXPECT_NEAR(outline_distance(a, b), 1.0, 1e-12);
  EXPECT_EQ(intersection_over_union(a, {{5, 5}, {6, 5}, {6, 6}}), 0.0);
  EXPECT_NEAR(outline_distance(a, {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {0, 1}}), 0.0, 1e-12);
}

}  // namespace
}  // namespace roadbook
