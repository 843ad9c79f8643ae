#include "vo/triangulation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/random.hpp"

namespace roadbook {
namespace {

Ray ray_to(const Eigen::Vector3d& origin, const Eigen::Vector3d& p) {
  return {origin, (p - origin).normalized()};
}

TEST(Triangulate, FindsThePointThatExactRaysMeet) {
  const Eigen::Vector3d p(3.0, -2.0, 5.0);
  const std::vector<Ray> rays{ray_to({0, 0, 0}, p), ray_to({1, 0, 0}, p), ray_to({0, 1, 0.2}, p)};
  const auto found = triangulate(rays, 0.01);
  ASSERT_TRUE(found);
  EXPECT_LT((found->p_world - p).norm(), 1e-9);
  EXPECT_LT(found->max_error_rad, 1e-7);
}

TEST(Triangulate, RefusesRaysWithoutParallax) {
  const Eigen::Vector3d far(1e6, 0.0, 0.0);
  EXPECT_FALSE(triangulate(std::vector<Ray>{ray_to({0, 0, 0}, far), ray_to({0, 1, 0}, far)}, 0.01));
}

TEST(Triangulate, RefusesAPointBehindACamera) {
  const std::vector<Ray> diverging{{{0, 0, 0}, Eigen::Vector3d(1, -0.2, 0).normalized()},
                                   {{0, 1, 0}, Eigen::Vector3d(1, 0.2, 0).normalized()}};
  EXPECT_FALSE(triangulate(diverging, 0.01));
}

// Two rays, baseline b, at range r: the depth is known to sigma r^2 / b (closed form).
TEST(Triangulate, DepthErrorFollowsTheClosedForm) {
  Random random(3);
  const double range = 8.0;
  const double baseline = 1.0;
  const double sigma = 1e-3;
  double squares = 0.0;
  constexpr int kTrials = 4000;
  for (int i = 0; i < kTrials; ++i) {
    const auto noisy = [&](double x) {
      const double angle = std::atan2(range, -x) + random.normal(0.0, sigma);
      return Ray{{x, 0, 0}, {std::cos(angle), std::sin(angle), 0.0}};
    };
    const auto found =
        triangulate(std::vector<Ray>{noisy(-baseline / 2), noisy(baseline / 2)}, 0.01);
    ASSERT_TRUE(found);
    squares += std::pow(found->p_world.y() - range, 2);
  }
  const double predicted =
      std::sqrt(2.0) * sigma * (range * range + baseline * baseline / 4) / baseline;
  EXPECT_NEAR(std::sqrt(squares / kTrials), predicted, 0.05 * predicted);
}

// Two rays that pass each other at h: each is missed by the same angle, so the point divides h by
// the squares of the ranges.
TEST(Triangulate, ANearRayCountsMoreThanAFarOne) {
  constexpr double kFar = 10.0;
  constexpr double kNear = 2.0;
  constexpr double kApart = 0.01;
  const std::vector<Ray> rays{{{-kFar, 0, 0}, {1, 0, 0}}, {{0, -kNear, kApart}, {0, 1, 0}}};
  const auto found = triangulate(rays, 0.01);
  ASSERT_TRUE(found);
  const double height = kApart * kFar * kFar / (kFar * kFar + kNear * kNear);
  EXPECT_LT((found->p_world - Eigen::Vector3d(0.0, 0.0, height)).norm(), 1e-6);
}

}  // namespace
}  // namespace roadbook
