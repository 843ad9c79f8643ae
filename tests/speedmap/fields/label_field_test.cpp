#include "speedmap/fields/label_field.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.hpp"
#include "base/random.hpp"

namespace roadbook {
namespace {

std::vector<LabelledOutline> random_boxes(int count) {
  Random random(5, "boxes");
  std::vector<LabelledOutline> boxes;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d c(random.uniform(-40.0, 40.0), random.uniform(-40.0, 40.0));
    const double heading = random.uniform(-3.0, 3.0);
    const Eigen::Vector2d a = 2.5 * Eigen::Vector2d(std::cos(heading), std::sin(heading));
    const Eigen::Vector2d b = 1.2 * Eigen::Vector2d(-std::sin(heading), std::cos(heading));
    LabelledOutline box{i, "parking_space", 0.1, {c + a + b, c - a + b, c - a - b, c + a - b}};
    if (i % 2 == 1) std::swap(box.corners[1], box.corners[3]);  // clockwise
    boxes.push_back(box);
  }
  return boxes;
}

// The distance of a box by its own axes.
double box_distance(const LabelledOutline& box, const Eigen::Vector2d& p) {
  const Eigen::Vector2d c = 0.5 * (box.corners[0] + box.corners[2]);
  const Eigen::Vector2d u = 0.5 * (box.corners[0] - box.corners[1]);
  const Eigen::Vector2d v = 0.5 * (box.corners[0] - box.corners[3]);
  const Eigen::Vector2d q(std::abs((p - c).dot(u.normalized())) - u.norm(),
                          std::abs((p - c).dot(v.normalized())) - v.norm());
  return q.cwiseMax(0.0).norm() + std::min(0.0, q.maxCoeff());
}

TEST(LabelField, FindsEveryLabelWithinReachNearestFirst) {
  const auto boxes = random_boxes(60);
  const LabelField field(boxes, 5.0);
  Random random(6, "places");
  std::vector<LabelAt> found;
  std::size_t inside = 0;
  for (int k = 0; k < 3000; ++k) {
    const Eigen::Vector2d p(random.uniform(-50.0, 50.0), random.uniform(-50.0, 50.0));
    field.at(p, found);
    std::size_t expected = 0;
    for (const LabelledOutline& box : boxes) expected += box_distance(box, p) <= 5.0 ? 1 : 0;
    ASSERT_EQ(found.size(), expected);
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_NEAR(found[i].distance_m, box_distance(*found[i].label, p), 1e-9);
      EXPECT_GE(found[i].distance_m, found[i > 0 ? i - 1 : 0].distance_m);
      if (found[i].distance_m < 0.0) ++inside;
    }
  }
  EXPECT_GT(inside, 30U);
}

TEST(LabelField, GradientsAgreeWithDifferencesAndPointOutward) {
  const LabelField field(random_boxes(60), 5.0);
  Random random(7, "places");
  std::vector<LabelAt> at, up, down;
  constexpr double kStep = 1e-6;
  int compared = 0;
  for (int k = 0; k < 3000; ++k) {
    const Eigen::Vector2d p(random.uniform(-45.0, 45.0), random.uniform(-45.0, 45.0));
    field.at(p, at);
    for (std::size_t i = 0; i < at.size(); ++i) {
      EXPECT_NEAR(at[i].gradient.norm(), 1.0, 1e-9);
      const auto beside = [&](const Eigen::Vector2d& d) {
        return box_distance(*at[i].label, p + d);
      };
      const Eigen::Vector2d x(kStep, 0.0), y(0.0, kStep);
      const Eigen::Vector2d slope((beside(x) - beside(-x)) / (2.0 * kStep),
                                  (beside(y) - beside(-y)) / (2.0 * kStep));
      // Within a box, the nearest edge changes on the diagonals.
      if (std::abs(slope.norm() - 1.0) > 1e-6) continue;
      EXPECT_LT((slope - at[i].gradient).norm(), 1e-6);
      ++compared;
    }
  }
  EXPECT_GT(compared, 1000);
  // On an edge the gradient is its outward normal, for both directions of the ring.
  for (const bool clockwise : {false, true}) {
    LabelledOutline square{1, "crossing", NAN, {{0, 0}, {4, 0}, {4, 4}, {0, 4}}};
    if (clockwise) std::reverse(square.corners.begin(), square.corners.end());
    LabelField({square}).at({4.0, 1.0}, at);
    ASSERT_EQ(at.size(), 1U);
    EXPECT_NEAR(at[0].distance_m, 0.0, 1e-12);
    EXPECT_LT((at[0].gradient - Eigen::Vector2d::UnitX()).norm(), 1e-9);
  }
}

TEST(LabelField, HasNothingWithoutLabelsAndRefusesWhatIsNotFinite) {
  std::vector<LabelAt> found(1);
  LabelField({}).at({0.0, 0.0}, found);
  EXPECT_TRUE(found.empty());
  LabelField(random_boxes(3)).at({NAN, 0.0}, found);
  EXPECT_TRUE(found.empty());
  auto boxes = random_boxes(1);
  boxes[0].corners[2].x() = INFINITY;
  EXPECT_THROW(LabelField{boxes}, InvalidOption);
  EXPECT_THROW(LabelField(random_boxes(1), 0.0), InvalidOption);
}

}  // namespace
}  // namespace roadbook
