#include "roadnet/paths/path_tube.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.hpp"
#include "base/random.hpp"
#include "roadnet/paths/path_fit.hpp"
#include "tests/roadnet/test_paths.hpp"

namespace roadbook {
namespace {

PathCurve fitted(const std::vector<Eigen::Vector3d>& points, int segments, bool closed = false) {
  return PathCurve(fit_path(points, {.segments = segments, .closed = closed}).path);
}

std::vector<Eigen::Vector3d> circle(double radius) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 300; ++i) {
    const double a = 2.0 * std::numbers::pi * i / 300;
    points.emplace_back(radius * std::cos(a), radius * std::sin(a), 0.0);
  }
  return points;
}

const TubeViolation* find(const TubeCheck& check, TubeCondition condition) {
  const auto found = std::find_if(check.violations.begin(), check.violations.end(),
                                  [=](const auto& v) { return v.condition == condition; });
  return found == check.violations.end() ? nullptr : &*found;
}

TEST(PathTube, AGentleRoadBreaksNothing) {
  const PathCurve road = fitted(test::TwoMileRoad::positions(281), 40);
  const TubeCheck check = check_tube(road, {-6.0, 6.0});
  EXPECT_TRUE(check.one_to_one());
  EXPECT_TRUE(
      std::all_of(check.safe_piece.begin(), check.safe_piece.end(), [](bool b) { return b; }));
}

TEST(PathTube, ACircleMayBeAsWideAsItsRadiusAndNoWider) {
  const PathCurve ring = fitted(circle(20.0), 24, true);
  EXPECT_TRUE(check_tube(ring, {-3.0, 19.9}).one_to_one());
  const TubeCheck check = check_tube(ring, {-20.1, 3.0});  // the larger side counts
  ASSERT_FALSE(check.one_to_one());
  ASSERT_NE(find(check, TubeCondition::kCurvature), nullptr);
  EXPECT_NEAR(find(check, TubeCondition::kCurvature)->got, 0.05, 1e-4);
  EXPECT_NEAR(widest_tube_m(ring, 50.0), 20.0, 0.06);
}

// A hairpin of radius 4 m in a road that is otherwise straight: its apex is known, and so are the
// straights that are 8 m apart.
TEST(PathTube, APlantedHairpinIsNamedWithinAMetre) {
  const PathCurve road(fit_path(test::hairpin(4.0), {.segments = 60, .smooth_below_m = 2.0}).path);
  const double apex = 60.0 + 0.5 * std::numbers::pi * 4.0;
  const TubeCheck check = check_tube(road, {-5.0, 5.0});
  const TubeViolation* bend = find(check, TubeCondition::kCurvature);
  ASSERT_NE(bend, nullptr);
  // A half circle is equally tight all along: the worst place is on it, and the stretch is it.
  EXPECT_NEAR(0.5 * (bend->s_begin_m + bend->s_end_m), apex, 1.0);
  EXPECT_NEAR(bend->s_begin_m, 60.0, 1.0);
  EXPECT_NEAR(bend->s_end_m, 2.0 * apex - 60.0, 1.0);
  EXPECT_GE(bend->s_m, 59.0);
  EXPECT_LE(bend->s_m, 2.0 * apex - 59.0);
  EXPECT_DOUBLE_EQ(bend->limit, 0.2);
  const TubeViolation* legs = find(check, TubeCondition::kClearance);
  ASSERT_NE(legs, nullptr);
  EXPECT_NEAR(legs->got, 8.0, 0.05);
  EXPECT_DOUBLE_EQ(legs->limit, 10.0);
  EXPECT_NEAR(legs->other_s_m, 2.0 * apex - legs->s_m, 1.0);
  EXPECT_NE(legs->text().find("distance to s"), std::string::npos);
  EXPECT_TRUE(check_tube(road, {-3.5, 3.5}).one_to_one());
}

TEST(PathTube, ASharpPlantedBendInAWindingRoadIsNamedWithinAMetre) {
  Random random(5);
  for (int trial = 0; trial < 10; ++trial) {
    // A straight with a turn of 1 rad, its curvature a bell of 3 m about a drawn place.
    const double place = random.uniform(60.0, 240.0);
    std::vector<Eigen::Vector3d> points{{0, 0, 0}};
    double heading = 0.0;
    for (int i = 0; i < 3000; ++i) {
      const double s = 0.1 * i + 0.05;
      const double bell = std::exp(-0.5 * std::pow((s - place) / 1.5, 2)) / (1.5 * 2.5066282746);
      heading += 0.1 * bell;
      points.push_back(points.back() +
                       0.1 * Eigen::Vector3d(std::cos(heading), std::sin(heading), 0));
    }
    const TubeCheck check = check_tube(fitted(points, 100), {-5.0, 5.0});
    ASSERT_EQ(check.violations.size(), 1U);
    EXPECT_EQ(check.violations[0].condition, TubeCondition::kCurvature);
    EXPECT_NEAR(check.violations[0].s_m, place, 1.0);
    EXPECT_NEAR(check.violations[0].got, 1.0 / (1.5 * 2.5066282746), 0.01);
  }
}

// Two straights at a slight angle, joined far away: the nearest places are at the mouth.
TEST(PathTube, TheNarrowestPlaceBetweenTwoLegsIsNamed) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i <= 100; ++i) points.emplace_back(i, 0.0, 0.0);
  for (int i = 1; i < 60; ++i) {
    const double a = -std::numbers::pi / 2 + std::numbers::pi * i / 60;
    points.emplace_back(100.0 + 15.0 * std::cos(a), 15.0 + 15.0 * std::sin(a), 0.0);
  }
  for (int i = 0; i <= 100; ++i) points.emplace_back(100 - i, 30.0 - 0.22 * i, 0.0);
  const PathCurve road = fitted(points, 40);
  const TubeCheck check = check_tube(road, {-6.0, 6.0});
  const TubeViolation* meeting = find(check, TubeCondition::kClearance);
  ASSERT_NE(meeting, nullptr);
  EXPECT_NEAR(meeting->got, 8.0, 0.01);
  EXPECT_NEAR(std::min(meeting->s_m, meeting->other_s_m), 0.0, 2.0);
  // Twelve metres apart, seen from the level leg: (8 + 0.22 x) cos(atan 0.22) = 12 at x = 19.5;
  // seen from the other: x = 18.2. Samples are 0.75 m apart.
  EXPECT_LT(meeting->s_m < 100 ? meeting->s_end_m : road.length_m() - meeting->s_begin_m, 20.3);
  EXPECT_TRUE(check_tube(road, {-3.5, 3.5}).one_to_one());
}

// Three quarters of a circle of 6 m that ends next to its entry: 6 m apart, but 34 m along the
// path. A path distance just above pi e_max already counts.
TEST(PathTube, ALoopThatComesBackBesideItselfIsNamed) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 80; ++i) points.emplace_back(0.5 * i - 40.0, 0.0, 0.0);
  for (int i = 0; i <= 120; ++i) {
    const double a = -std::numbers::pi / 2 + 1.5 * std::numbers::pi * i / 120;
    points.emplace_back(6.0 * std::cos(a), 6.0 + 6.0 * std::sin(a), 0.0);
  }
  const PathCurve road(fit_path(points, {.segments = 60, .smooth_below_m = 2.0}).path);
  const TubeCheck check = check_tube(road, {-5.0, 5.0});
  EXPECT_EQ(find(check, TubeCondition::kCurvature), nullptr);
  const TubeViolation* meeting = find(check, TubeCondition::kClearance);
  ASSERT_NE(meeting, nullptr);
  EXPECT_NEAR(meeting->got, 6.0, 0.05);
  EXPECT_NEAR(std::min(meeting->s_m, meeting->other_s_m), 34.0, 1.0);
  EXPECT_NEAR(std::max(meeting->s_m, meeting->other_s_m), road.length_m(), 1.0);
  EXPECT_TRUE(check_tube(road, {-2.9, 2.9}).one_to_one());
}

TEST(PathTube, APathThatCrossesItselfIsNamedAtTheCrossing) {
  std::vector<Eigen::Vector3d> eight;
  for (int i = 0; i < 400; ++i) {
    const double a = 2.0 * std::numbers::pi * i / 400 + 0.7;
    eight.emplace_back(80.0 * std::sin(a), 40.0 * std::sin(2.0 * a), 0.0);
  }
  const TubeCheck check = check_tube(fitted(eight, 30, true), {-2.0, 2.0});
  const TubeViolation* crossing = find(check, TubeCondition::kClearance);
  ASSERT_NE(crossing, nullptr);
  EXPECT_LT(crossing->got, 1e-3);
  EXPECT_LT(crossing->position.norm(), 0.1);
  try {
    require_one_to_one(check, "path of lane 7");
    FAIL() << "a path that crosses itself was taken";
  } catch (const BadInput& bad) {
    EXPECT_NE(std::string(bad.what()).find("error: path of lane 7: got s "), std::string::npos)
        << bad.what();
  }
  require_one_to_one(check_tube(fitted(circle(20.0), 24, true), {-3.0, 3.0}), "ring");
}

TEST(PathTube, ATubeWithoutWidthOrOnOneSideOnlyIsRefused) {
  const PathCurve ring = fitted(circle(20.0), 24, true);
  EXPECT_THROW((void)check_tube(ring, {0.0, 0.0}), InvalidOption);
  EXPECT_THROW((void)check_tube(ring, {1.0, 2.0}), InvalidOption);
  EXPECT_THROW((void)check_tube(ring, {-1.0, std::nan("")}), InvalidOption);
  EXPECT_TRUE(check_tube(ring, {0.0, 2.0}).one_to_one());
}

}  // namespace
}  // namespace roadbook
