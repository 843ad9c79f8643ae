#include "diagnosis/views/body_motion_correlation.hpp"

#include <gtest/gtest.h>

#include "base/random.hpp"

namespace roadbook {
namespace {

constexpr double kWheelbase = 2.5;
constexpr std::size_t kLong = 4000;
using Left = std::array<std::vector<double>, 6>;

// Motions of a quarter of a metre: ten to a wheelbase.
std::vector<MotionConstraint> drive(std::size_t count) {
  std::vector<MotionConstraint> motions(count);
  for (std::size_t m = 0; m < count; ++m) {
    motions[m].from = static_cast<int>(m);
    motions[m].to = static_cast<int>(m) + 1;
    motions[m].T_from_to.translation().x() = 0.25;
  }
  return motions;
}

// For every axis sums of the last `width` independent deviations.
Left swaying(std::size_t count, std::size_t width) {
  Left left;
  Random random(width);
  for (auto& axis : left) {
    std::vector<double> white;
    for (std::size_t m = 0; m < count + width; ++m) white.push_back(random.normal());
    for (std::size_t m = 0; m < count; ++m) {
      double sum = 0.0;
      for (std::size_t k = 0; k < width; ++k) sum += white[m + k];
      axis.push_back(sum);
    }
  }
  return left;
}

TEST(Sway, IsOneOfIndependentMotions) {
  for (const double ratio : motion_variance_inflation(drive(kLong), kWheelbase, swaying(kLong, 1)))
    EXPECT_NEAR(ratio, 1.0, 0.1);
}

// Autocorrelation 1 - k/10: the ten of a wheelbase sum to 10 + 2 sum (10 - k)(1 - k/10) = 67.
TEST(Sway, IsThatOfTheMotionsAutocorrelation) {
  const auto ratios = motion_variance_inflation(drive(kLong), kWheelbase, swaying(kLong, 10));
  for (std::size_t axis = 2; axis < 5; ++axis) EXPECT_NEAR(ratios[axis], 6.7, 0.9) << axis;
  for (const std::size_t axis : {0U, 1U, 5U}) EXPECT_EQ(ratios[axis], 1.0) << axis;
}

TEST(Sway, OfMotionsThatTakeEachOtherBackIsOne) {
  Left left;
  for (auto& axis : left)
    for (std::size_t m = 0; m < 100; ++m) axis.push_back(m % 2 == 0 ? 1.0 : -1.0);
  for (const double ratio : motion_variance_inflation(drive(100), kWheelbase, left))
    EXPECT_EQ(ratio, 1.0);
}

// Pieces shorter than a wheelbase are not used; sums do not cross a gap.
TEST(Sway, IsNotSummedOverGaps) {
  std::vector<MotionConstraint> motions = drive(200);
  for (std::size_t m = 0; m < motions.size(); ++m) {
    motions[m].from += static_cast<int>(m / 5);
    motions[m].to += static_cast<int>(m / 5);
  }
  for (const double ratio : motion_variance_inflation(motions, kWheelbase, swaying(200, 10)))
    EXPECT_EQ(ratio, 1.0);
  motions = drive(20);
  for (std::size_t m = 10; m < 20; ++m) ++motions[m].from, ++motions[m].to;
  Left left;
  for (auto& axis : left) {
    axis.assign(10, 1.0);
    axis.resize(20, -1.0);
  }
  const auto ratios = motion_variance_inflation(motions, kWheelbase, left);
  for (std::size_t axis = 2; axis < 5; ++axis) EXPECT_DOUBLE_EQ(ratios[axis], 10.0);
}

}  // namespace
}  // namespace roadbook
