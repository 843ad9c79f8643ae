#include "base/geometry/outline.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"

namespace roadbook {
namespace {

// A star without crossing edges, whose corners run either way.
std::vector<Eigen::Vector2d> star(Random& random) {
  std::vector<Eigen::Vector2d> corners;
  const int count = 3 + static_cast<int>(random.below(9));
  const double way = random.below(2) == 0 ? 1.0 : -1.0;
  for (int i = 0; i < count; ++i) {
    const double angle = way * 2.0 * M_PI * i / count;
    corners.push_back(random.uniform(0.5, 3.0) * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return corners;
}

// Sum of the angles under which the edges are seen: a whole turn from inside, none from outside.
bool sees_a_whole_turn(const std::vector<Eigen::Vector2d>& corners, const Eigen::Vector2d& p) {
  double turn = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d a = corners[i] - p;
    const Eigen::Vector2d b = corners[(i + 1) % corners.size()] - p;
    turn += std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
  }
  return std::abs(turn) > M_PI;
}

TEST(Outline, APointIsInsideWhereTheEdgesAreAWholeTurnAround) {
  Random random(3, "outline");
  int inside = 0;
  for (int i = 0; i < 200; ++i) {
    const auto corners = star(random);
    for (int k = 0; k < 50; ++k) {
      const Eigen::Vector2d p(random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0));
      EXPECT_EQ(is_inside(corners, p), sees_a_whole_turn(corners, p));
      inside += is_inside(corners, p) ? 1 : 0;
    }
  }
  EXPECT_GT(inside, 1000);
  EXPECT_FALSE(is_inside({}, {0.0, 0.0}));
}

TEST(Outline, ThePointOfASegmentThatIsNearestGivesTheDistance) {
  Random random(4, "segment");
  const auto point = [&] {
    const double x = random.uniform(-2.0, 2.0);
    const double y = random.uniform(-2.0, 2.0);
    return Eigen::Vector3d(x, y, random.uniform(-2.0, 2.0));
  };
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d p = point(), a = point(), b = point();
    double nearest = INFINITY;
    for (int k = 0; k <= 10000; ++k)
      nearest = std::min(nearest, (a + k / 10000.0 * (b - a) - p).norm());
    EXPECT_NEAR(distance_to_segment(p, a, b), nearest, 1e-6);
    EXPECT_DOUBLE_EQ(distance_to_segment(p, a, a), (p - a).norm());
  }
}

}  // namespace
}  // namespace roadbook
