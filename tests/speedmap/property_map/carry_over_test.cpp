#include "speedmap/property_map/carry_over.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.hpp"
#include "base/random.hpp"
#include "roadnet/paths/path_fit.hpp"
#include "roadnet/paths/path_frame.hpp"
#include "tests/speedmap/small_property_map.hpp"

namespace roadbook {
namespace {

PropertyMap carried_map() {
  PropertyMap map = test::small_map({});
  Random random(1);
  for (int i = 0; i < 4000; ++i) {
    const PathPlace v{random.uniform(0.0, 20.0), random.uniform(-3.0, 3.0)};
    map.add_label(v, v.s_m < 8.0 ? 0 : v.e_m > 0.0 ? 1 : 2);
    if (i % 4 == 0) map.add_value(0, v, v.s_m < 8.0 ? 0.6 : v.e_m > 0.0 ? 0.9 : 0.4);
  }
  return map;
}

double total_evidence(const PropertyMap& map) {
  double sum = 0.0;
  for (std::size_t l = 0; l < map.knots().size(); ++l) sum += map.knot_evidence(l);
  return sum;
}

TEST(CarryOver, AShiftedPathChangesNothingOnTheGround) {
  const PropertyMap before = carried_map();
  const CarriedMap after = carry_over(before, [](const PathPlace& v) {
    return PathPlace{v.s_m + 3.0, v.e_m - 0.3};
  });
  EXPECT_EQ(after.dropped, 0U);
  EXPECT_EQ(total_evidence(after.map), total_evidence(before));
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const PathPlace v{random.uniform(0.0, 20.0), random.uniform(-3.0, 3.0)};
    const auto a = before.moments(0, v);
    const auto b = after.map.moments(0, {v.s_m + 3.0, v.e_m - 0.3});
    EXPECT_NEAR(a->mean, b->mean, 1e-12);
    EXPECT_NEAR(a->variance, b->variance, 1e-12);
  }
}

// The old path is the x axis; the new one bends away from it by up to 0.5 m.
TEST(CarryOver, OnABentPathTheFieldStaysWithinFiveCentimetresOfTheGround) {
  const PropertyMap before = carried_map();
  std::vector<Eigen::Vector3d> points;
  for (double x = -2.0; x <= 22.0; x += 0.5) points.emplace_back(x, 0.5 * std::sin(0.3 * x), 0.0);
  PathFitOptions fit;
  fit.segments = 6;
  const PathFrame path(PathCurve(fit_path(points, fit).path), Tube{-4.0, 4.0});
  const auto move = [&](const PathPlace& v) -> std::optional<PathPlace> {
    const PathProjection at = path.project({v.s_m, v.e_m});
    if (!at.inside()) return std::nullopt;
    return PathPlace{at.s_m, at.e_m};
  };
  const CarriedMap after = carry_over(before, move);
  EXPECT_EQ(after.dropped, 0U);
  EXPECT_NEAR(total_evidence(after.map), total_evidence(before), 1e-9);
  Random random(3);
  for (int i = 0; i < 300; ++i) {
    const PathPlace v{random.uniform(2.0, 18.0), random.uniform(-2.5, 2.5)};
    const auto a = before.moments_with_derivatives(0, v);
    const auto b = after.map.moments(0, *move(v));
    ASSERT_TRUE(a && b);
    // Off by what 5 cm of the field's own slope give, and what curvature (0.045 1/m) makes of the
    // distances within a kernel: 2 m * 0.045 * 3 m / 2 of a knot spacing, as second-order blur.
    EXPECT_NEAR(a->mean, b->mean, 0.05 * a->d_mean.norm() + 0.01);
  }
}

TEST(CarryOver, KnotsBesideTheNewPathAreDroppedAndCounted) {
  const PropertyMap before = carried_map();
  const CarriedMap after = carry_over(before, [](const PathPlace& v) -> std::optional<PathPlace> {
    if (v.e_m > 2.5) return std::nullopt;
    return v;
  });
  EXPECT_EQ(after.dropped, 21U);
  EXPECT_THROW(carry_over(before, [](const PathPlace&) { return std::optional<PathPlace>(); }),
               Refused);
}

}  // namespace
}  // namespace roadbook
