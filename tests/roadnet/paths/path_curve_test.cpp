#include "roadnet/paths/path_curve.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.hpp"
#include "base/random.hpp"
#include "roadnet/paths/path_fit.hpp"
#include "tests/roadnet/test_paths.hpp"

namespace roadbook {
namespace {

// y = x^2 over [0, a], as a Bezier curve raised to degree 6 by its blossom.
BezierPath parabola(double a) {
  BezierPath path;
  path.knots = {0.0, 1.0};
  for (int k = 0; k <= 6; ++k)
    path.points.emplace_back(a * k / 6.0, a * a * k * (k - 1) / 30.0, 0.0);
  return path;
}

TEST(PathCurve, AParabolaHasTheLengthOfItsClosedForm) {
  for (const double a : {0.1, 1.0, 7.0, 100.0}) {
    const PathCurve curve(parabola(a));
    const double length = 0.5 * a * std::hypot(1.0, 2.0 * a) + 0.25 * std::asinh(2.0 * a);
    EXPECT_NEAR(curve.length_m(), length, 1e-13 * std::max(1.0, length)) << a;
    // The curvature is 2 / (1 + 4 x^2)^(3/2); the test gets x from the position.
    for (int i = 0; i <= 20; ++i) {
      const PathPoint p = curve.at(curve.length_m() * i / 20.0);
      EXPECT_NEAR(p.position.y(), p.position.x() * p.position.x(), 1e-11 * a * a);
      EXPECT_NEAR(p.curvature, 2.0 / std::pow(1.0 + 4.0 * p.position.x() * p.position.x(), 1.5),
                  1e-10);
    }
  }
}

// Arc length by an independent rule: a million chords, whose error is k^2 h^2 / 24 of the length.
TEST(PathCurve, ArcLengthIsTheSumOfChords) {
  const PathCurve curve(fit_path(test::ring(160), {.segments = 8, .closed = true}).path);
  double chords = 0.0;
  const BezierPath& path = curve.bezier();
  Eigen::Vector3d before = path.points.front();
  const int steps = 20000;
  for (int i = 0; i < path.segments(); ++i) {
    for (int k = 1; k <= steps; ++k) {
      double weights[kMaxPathDegree + 1];
      bernstein(path.degree, static_cast<double>(k) / steps, weights);
      Eigen::Vector3d p = Eigen::Vector3d::Zero();
      for (int j = 0; j <= path.degree; ++j) p += weights[j] * path.segment(i)[j];
      chords += (p - before).norm();
      before = p;
    }
  }
  // Chords of 5 mm on bends of at least 30 m: 1e-9 of 800 m.
  EXPECT_NEAR(curve.length_m(), chords, 2e-6);
}

TEST(PathCurve, MovesWithUnitSpeedAndTurnsByItsCurvature) {
  const PathCurve curve(fit_path(test::TwoMileRoad::positions(281), {.segments = 40}).path);
  Random random(3);
  const double h = 1e-3;
  for (int i = 0; i < 500; ++i) {
    const double s = random.uniform(1.0, curve.length_m() - 1.0);
    const PathPoint p = curve.at(s);
    const Eigen::Vector2d forward =
        (curve.at(s + h).position - curve.at(s - h).position) / (2.0 * h);
    // Central differences: third derivative times h^2 / 6, and rounding of kilometres over 2 h.
    EXPECT_LT((forward - p.tangent).norm(), 1e-8);
    const double turn = (curve.at(s + h).heading() - curve.at(s - h).heading()) / (2.0 * h);
    EXPECT_NEAR(turn, p.curvature, 1e-8);
    // The road's own curvature: the fit is 4 mm off at most over waves of tens of metres.
    EXPECT_NEAR(p.curvature, test::TwoMileRoad::curvature(s), 1e-3);
  }
}

TEST(PathCurve, ArcLengthAndParameterGoThereAndBackToRounding) {
  const PathCurve curve(fit_path(test::ring(160), {.segments = 8, .closed = true}).path);
  Random random(5);
  for (int i = 0; i < 2000; ++i) {
    const double s = random.uniform(0.0, curve.length_m());
    const PathPiece& piece = curve.pieces()[curve.piece_at(s)];
    EXPECT_NEAR(piece.s_begin_m + piece.arc_at(piece.v_at(s - piece.s_begin_m)), s, 1e-11);
  }
}

TEST(PathCurve, GoesRoundARingAndStopsAtOpenEnds) {
  const PathCurve ring(fit_path(test::ring(160), {.segments = 8, .closed = true}).path);
  const double L = ring.length_m();
  EXPECT_LT((ring.at(5.0).position - ring.at(5.0 + 3.0 * L).position).norm(), 1e-9);
  EXPECT_LT((ring.at(-1.0).position - ring.at(L - 1.0).position).norm(), 1e-9);
  EXPECT_DOUBLE_EQ(ring.distance_along(1.0, L - 1.0), 2.0);
  EXPECT_EQ(ring.wrapped(-1e-20), 0.0);
  const PathCurve road(fit_path(test::TwoMileRoad::positions(281)).path);
  EXPECT_EQ(road.at(-4.0).position, road.at(0.0).position);
  EXPECT_DOUBLE_EQ(road.distance_along(1.0, 3000.0), 2999.0);
}

TEST(PathCurve, TheWayBackHasTheSamePlacesAndTheOppositeBends) {
  const BezierPath there = fit_path(test::TwoMileRoad::positions(281)).path;
  const PathCurve a(there);
  const PathCurve b(reversed(there));
  EXPECT_NEAR(a.length_m(), b.length_m(), 1e-9);
  for (double s = 10.0; s < 3200.0; s += 97.0) {
    EXPECT_LT((a.at(s).position - b.at(a.length_m() - s).position).norm(), 1e-9);
    EXPECT_NEAR(a.at(s).curvature, -b.at(a.length_m() - s).curvature, 1e-9);
  }
}

TEST(PathCurve, HeightRidesAlong) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i <= 100; ++i) points.emplace_back(i, 0.0, 0.05 * i);
  const PathCurve curve(fit_path(points, {.segments = 4}).path);
  EXPECT_NEAR(curve.length_m(), 100.0, 1e-9);  // in plan
  EXPECT_NEAR(curve.at(40.0).height_m, 2.0, 1e-9);
}

TEST(PathCurve, ACuspIsRefused) {
  BezierPath path;
  path.degree = 3;
  path.knots = {0.0, 1.0};
  path.points = {{0, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 0}};  // the classical cubic with a cusp
  try {
    const PathCurve curve(path);
    FAIL() << "length " << curve.length_m();
  } catch (const BadInput& bad) {
    EXPECT_NE(std::string(bad.what()).find("cusp"), std::string::npos) << bad.what();
  }
  path.knots = {1.0, 0.0};
  EXPECT_THROW(PathCurve{path}, BadInput);
  path.points.pop_back();
  EXPECT_THROW(PathCurve{path}, BadInput);
}

}  // namespace
}  // namespace roadbook
