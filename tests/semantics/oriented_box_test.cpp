#include "semantics/oriented_box.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "base/random.hpp"

namespace roadbook {
namespace {

OrientedBox random_box(Random& random) {
  return {{random.uniform(-2.0, 2.0), random.uniform(-2.0, 2.0)},
          random.uniform(-4.0, 4.0),
          random.uniform(1.0, 6.0),
          random.uniform(1.0, 4.0)};
}

TEST(OrientedBox, OverlapEqualsACountOfRandomPoints) {
  Random random(1, "boxes");
  for (int k = 0; k < 30; ++k) {
    const OrientedBox a = random_box(random);
    const OrientedBox b = random_box(random);
    int either = 0;
    int both = 0;
    for (int i = 0; i < 40000; ++i) {
      const Eigen::Vector2d p(random.uniform(-7.0, 7.0), random.uniform(-7.0, 7.0));
      const bool in_a = a.contains(p);
      const bool in_b = b.contains(p);
      either += in_a || in_b ? 1 : 0;
      both += in_a && in_b ? 1 : 0;
    }
    // At least 200 points in the union: four standard deviations of a share are below 0.15; most
    // are far closer.
    const double counted = static_cast<double>(both) / either;
    EXPECT_NEAR(intersection_over_union(a, b), counted, 4.0 * std::sqrt(0.25 / either) + 1e-12);
    EXPECT_NEAR(intersection_over_union(a, b), intersection_over_union(b, a), 1e-12);
  }
}

TEST(OrientedBox, ABoxOverlapsItselfWhollyAlsoTurnedByHalfATurn) {
  Random random(2, "boxes");
  OrientedBox box = random_box(random);
  EXPECT_NEAR(intersection_over_union(box, box), 1.0, 1e-12);
  OrientedBox turned = box;
  turned.heading += std::numbers::pi;
  EXPECT_NEAR(intersection_over_union(box, turned), 1.0, 1e-12);
}

TEST(OrientedBox, ThreeClicksOnItsCornersGiveTheBoxBack) {
  Random random(3, "boxes");
  for (int k = 0; k < 20; ++k) {
    const OrientedBox box = random_box(random);
    const auto corner = box.corners();  // ahead right, ahead left, behind left, behind right
    const OrientedBox right = box_of_clicks(corner[3], corner[0], corner[1]);
    const OrientedBox left = box_of_clicks(corner[2], corner[1], corner[3]);
    for (const OrientedBox& got : {right, left}) {
      EXPECT_NEAR((got.centre - box.centre).norm(), 0.0, 1e-12);
      EXPECT_NEAR(got.length_m, box.length_m, 1e-12);
      EXPECT_NEAR(got.width_m, box.width_m, 1e-12);
      EXPECT_NEAR(std::cos(got.heading - box.heading), 1.0, 1e-12);
    }
  }
}

TEST(OrientedBox, OfOverlappingBoxesTheBestStays) {
  const OrientedBox box;
  OrientedBox beside = box;
  beside.centre.y() += 2.5;
  OrientedBox between = box;
  between.centre.y() += 1.0;
  const std::vector<OrientedBox> boxes{between, box, beside};
  const std::vector<double> scores{0.5, 0.9, 0.7};
  EXPECT_EQ(non_maximum_suppression(boxes, scores, 0.2), (std::vector<std::size_t>{1, 2}));
}

TEST(OrientedBox, EachTrueBoxIsFoundOnce) {
  const OrientedBox truth;
  OrientedBox near = truth;
  near.centre.x() += 0.2;
  OrientedBox nearer = truth;
  nearer.centre.x() += 0.1;
  const std::vector<OrientedBox> found{near, nearer};
  EXPECT_EQ(match_boxes(found, std::vector<OrientedBox>{truth}, 0.5), (std::vector<int>{-1, 0}));
}

}  // namespace
}  // namespace roadbook
