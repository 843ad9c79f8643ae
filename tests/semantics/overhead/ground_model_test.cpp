#include "semantics/overhead/ground_model.hpp"

#include <gtest/gtest.h>

namespace roadbook {
namespace {

TEST(GroundModel, ContinuesAPlaneBeyondTheEvidence) {
  std::vector<GroundPoint> points;
  for (double x = -2; x <= 2; x += 0.5)
    for (double y = -2; y <= 2; y += 0.5)
      points.push_back({{x, y, 0.3 + 0.03 * x - 0.02 * y}, 0.01});
  const GroundModel ground = GroundModel::fit(points, {Eigen::Vector2d::Zero()});
  // The weak coupling of neighbours flattens the plane by far less than the sigma of the points.
  for (const Eigen::Vector2d& p :
       {Eigen::Vector2d(0, 0), Eigen::Vector2d(8, 0), Eigen::Vector2d(-5, 6)}) {
    ASSERT_TRUE(ground.height(p.x(), p.y()));
    EXPECT_NEAR(*ground.height(p.x(), p.y()), 0.3 + 0.03 * p.x() - 0.02 * p.y(), 0.01);
  }
  EXPECT_FALSE(ground.height(40, 0));
}

}  // namespace
}  // namespace roadbook
