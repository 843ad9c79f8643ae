#include "roadnet/paths/path_frame.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "base/random.hpp"
#include "roadnet/paths/path_fit.hpp"
#include "roadnet/paths/path_sign.hpp"
#include "tests/roadnet/test_paths.hpp"
#include "tests/support/real_data.hpp"

namespace roadbook {
namespace {

PathCurve two_mile_road() {
  return PathCurve(fit_path(test::TwoMileRoad::positions(281), {.segments = 40}).path);
}

PathCurve circle(double radius, bool closed) {
  std::vector<Eigen::Vector3d> points;
  const int n = 400;
  for (int i = 0; i < n; ++i) {
    const double a = 2.0 * std::numbers::pi * i / n;
    points.emplace_back(radius * std::cos(a), radius * std::sin(a), 0.0);
  }
  return PathCurve(fit_path(points, {.segments = 24, .closed = closed}).path);
}

void expect_round_trips(const PathFrame& frame, std::uint64_t seed) {
  Random random(seed);
  PathCursor cursor;
  for (int i = 0; i < 5000; ++i) {
    const double s = random.uniform(0.0, frame.curve().length_m());
    const double e = random.uniform(frame.tube().e_min_m, frame.tube().e_max_m);
    const auto p = frame.position(s, e);
    ASSERT_TRUE(p);
    // Warm from a random other place, and cold.
    for (const PathProjection& found : {frame.project(*p, cursor), frame.project(*p)}) {
      ASSERT_TRUE(found.inside()) << to_text(found.status) << " s " << s << " e " << e;
      EXPECT_LT(frame.curve().distance_along(found.s_m, s), 1e-9);
      EXPECT_NEAR(found.e_m, e, 1e-9);
      EXPECT_LT((*frame.position(found.s_m, found.e_m) - *p).norm(), 1e-9);
    }
  }
}

TEST(PathFrame, RoundTripIsExactToANanometreInsideTheTube) {
  expect_round_trips(PathFrame(two_mile_road(), {-6.0, 6.0}), 1);
  expect_round_trips(
      PathFrame(PathCurve(fit_path(test::ring(160), {.segments = 8, .closed = true}).path),
                {-20.0, 12.0}),
      2);
}

// Half a circle of 10 m radius, from (10, 0) over (0, 10) to (-10, 0), with its centre on the left.
TEST(PathFrame, APointBeyondTheCentreOfAnOpenBendIsNotInside) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i <= 100; ++i) {
    const double a = std::numbers::pi * i / 100.0;
    points.emplace_back(10.0 * std::cos(a), 10.0 * std::sin(a), 0.0);
  }
  const PathFrame frame(PathCurve(fit_path(points, {.segments = 8}).path), {-3.0, 14.0});
  for (const double y : {-1.0, -3.0}) {
    EXPECT_EQ(frame.project({0.5, y}).status, ProjectionStatus::kNotUnique) << y;
    PathCursor cursor;
    ASSERT_TRUE(frame.project({0.0, 8.0}, cursor).inside());
    EXPECT_EQ(frame.project({0.5, y}, cursor).status, ProjectionStatus::kNotUnique) << y;
  }
  // On this side of the centre, there is one foot.
  const PathProjection near = frame.project({0.0, 2.0});
  ASSERT_TRUE(near.inside());
  EXPECT_NEAR(near.e_m, 8.0, 1e-3);
}

TEST(PathFrame, RoundTripHoldsOnRealTracks) {
  ROADBOOK_REQUIRE_DATA(folder, "racetracks_friction");
  for (const char* name : test::kTracks) {
    const auto points = test::track_centre(folder, name);
    const PathCurve curve(
        fit_path(points, {.segments = static_cast<int>(points.size()) / 8, .closed = true}).path);
    const double e = widest_tube_m(curve, 6.0);
    EXPECT_GT(e, 3.0) << name;
    expect_round_trips(PathFrame(curve, {-e, e}), 4);
  }
}

TEST(PathFrame, LeftIsPositiveAndTheDocumentsSignIsTheOpposite) {
  const PathFrame frame(circle(50.0, true), {-10.0, 10.0});
  // Driven counter-clockwise, left is towards the middle.
  const auto left = frame.project({48.0, 0.0});
  const auto right = frame.project({53.0, 0.0});
  EXPECT_NEAR(left.e_m, 2.0, 1e-6);
  EXPECT_NEAR(right.e_m, -3.0, 1e-6);
  EXPECT_NEAR(frame.curve().at(3.0).curvature, 1.0 / 50.0, 1e-6);
  // Equation (5) word for word, with the cross product as printed.
  for (const Eigen::Vector2d& p : {Eigen::Vector2d(48.0, 0.0), Eigen::Vector2d(53.0, 0.0)}) {
    const auto found = frame.project(p);
    const PathPoint g = frame.curve().at(found.s_m);
    const Eigen::Vector2d d = g.position - p;
    const double cross = g.tangent.x() * d.y() - g.tangent.y() * d.x();
    const double e_document = std::copysign(d.norm(), cross);
    EXPECT_NEAR(to_paper_sign(found.e_m), e_document, 1e-9);
    EXPECT_NEAR(from_paper_sign(e_document), found.e_m, 1e-9);
    const Eigen::Vector2d back(g.position.x() + e_document * g.tangent.y(),
                               g.position.y() - e_document * g.tangent.x());
    EXPECT_LT((back - p).norm(), 1e-9);
  }
}

TEST(PathFrame, SaysWhereAPointIsNotInsteadOfGivingANumber) {
  const PathFrame frame(two_mile_road(), {-6.0, 6.0});
  const PathPoint start = frame.curve().at(0.0);
  const PathPoint end = frame.curve().at(frame.curve().length_m());
  const auto expect = [&](const Eigen::Vector2d& p, ProjectionStatus status) {
    PathCursor cursor{3, 0.5};
    for (const PathProjection& found : {frame.project(p), frame.project(p, cursor)}) {
      EXPECT_EQ(found.status, status) << to_text(found.status);
      EXPECT_TRUE(std::isnan(found.s_m));
      EXPECT_TRUE(std::isnan(found.e_m));
    }
  };
  expect(start.position - 0.5 * start.tangent, ProjectionStatus::kBeforeStart);
  expect(start.position - 3.0 * start.tangent + 2.0 * start.left(), ProjectionStatus::kBeforeStart);
  expect(end.position + 0.5 * end.tangent, ProjectionStatus::kBeyondEnd);
  expect(end.position + 300.0 * end.tangent, ProjectionStatus::kBeyondEnd);
  const PathPoint middle = frame.curve().at(1500.0);
  expect(middle.position + 6.001 * middle.left(), ProjectionStatus::kOutsideTube);
  expect(middle.position - 60.0 * middle.left(), ProjectionStatus::kOutsideTube);
  expect({std::nan(""), 0.0}, ProjectionStatus::kOutsideTube);
  expect({1e300, 1e300}, ProjectionStatus::kOutsideTube);
  EXPECT_FALSE(frame.position(10.0, 6.001));
  EXPECT_FALSE(frame.position(-0.001, 0.0));
  EXPECT_FALSE(frame.position(std::nan(""), 0.0));
  EXPECT_TRUE(frame.position(10.0, 6.0));
  // Points exactly sideways of the ends are inside.
  EXPECT_TRUE(frame.project(start.position + 5.0 * start.left()).inside());
  EXPECT_TRUE(frame.project(end.position - 5.0 * end.left()).inside());
}

TEST(PathFrame, TheMiddleOfACircleBelongsToNoPlaceOfIt) {
  const PathFrame frame(circle(5.0, true), {-1.0, 7.0});
  EXPECT_FALSE(frame.violations().empty());
  EXPECT_EQ(frame.project({0.0, 0.0}).status, ProjectionStatus::kNotUnique);
  // Every point within 2 m of the middle has the far side 7 m away or nearer, too.
  EXPECT_EQ(frame.project({1.5, 0.0}).status, ProjectionStatus::kNotUnique);
  const auto found = frame.project({3.0, 0.0});
  ASSERT_TRUE(found.inside()) << to_text(found.status);
  EXPECT_NEAR(found.e_m, 2.0, 1e-3);
}

// The slow reference finds all foot points from the sign of the slope, at a step of 1 cm.
int count_feet(const PathCurve& curve, const Tube& tube, const Eigen::Vector2d& p) {
  int feet = 0;
  const int steps = static_cast<int>(curve.length_m() / 0.01);
  PathPoint before = curve.at(0.0);
  for (int i = 1; i <= steps; ++i) {
    const PathPoint at = curve.at(curve.length_m() * i / steps);
    const double a = (before.position - p).dot(before.tangent);
    const double b = (at.position - p).dot(at.tangent);
    const double e = at.left().dot(p - at.position);
    if ((a < 0.0) != (b < 0.0) && e > tube.e_min_m && e < tube.e_max_m) ++feet;
    before = at;
  }
  return feet;
}

TEST(PathFrame, AgreesWithCountingAllFootPointsWhereThePathCrossesItselfAndTurnsTightly) {
  std::vector<Eigen::Vector3d> eight;
  for (int i = 0; i < 200; ++i) {
    const double a = 2.0 * std::numbers::pi * i / 200;
    eight.emplace_back(40.0 * std::sin(a), 20.0 * std::sin(2.0 * a), 0.0);
  }
  const PathCurve crossing(fit_path(eight, {.segments = 20, .closed = true}).path);
  const PathCurve tight(fit_path(test::hairpin(3.0), {.segments = 40, .smooth_below_m = 2.0}).path);
  Random random(11);
  for (const PathCurve& curve : {crossing, tight}) {
    const Tube tube{-5.0, 5.0};
    const PathFrame frame(curve, tube);
    EXPECT_FALSE(frame.violations().empty());
    PathCursor cursor;
    int several = 0;
    for (int i = 0; i < 300; ++i) {
      const PathPoint near = curve.at(random.uniform(0.0, curve.length_m()));
      const Eigen::Vector2d p =
          near.position + Eigen::Vector2d(random.uniform(-7.0, 7.0), random.uniform(-7.0, 7.0));
      const int feet = count_feet(curve, tube, p);
      const ProjectionStatus status = frame.project(p).status;
      const ProjectionStatus warm = frame.project(p, cursor).status;
      EXPECT_EQ(status, warm);
      const bool inside = status == ProjectionStatus::kInside;
      EXPECT_EQ(inside, feet == 1) << p.transpose() << ": " << feet << " feet";
      EXPECT_EQ(status == ProjectionStatus::kNotUnique, feet > 1) << p.transpose();
      several += feet > 1 ? 1 : 0;
    }
    EXPECT_GE(several, 10) << "too few to tell";
  }
}

nlohmann::json read_json(const std::filesystem::path& file) {
  std::ifstream in(file);
  return nlohmann::json::parse(in);
}

Eigen::Vector3d point_of(const nlohmann::json& xy) { return {xy[0], xy[1], 0.0}; }

// Expected values of 20 to 30 digits, with the paper's sign of e.
TEST(PathFrame, EqualsTheGoldenValues) {
  const auto folder = test::source_tree() / "tests" / "golden" / "spm";
  for (const char* name : {"path_open.json", "path_closed.json"}) {
    SCOPED_TRACE(name);
    const auto golden = read_json(folder / name);
    const auto& test_case = golden.at("cases").at(0);
    std::vector<Eigen::Vector3d> points;
    for (const auto& xy : test_case.at("points_xy")) points.push_back(point_of(xy));
    const auto t = test_case.at("t").get<std::vector<double>>();
    const PathFit fit = fit_path(points, t, test_case.at("t_end"),
                                 {.segments = test_case.at("M"),
                                  .degree = test_case.at("degree"),
                                  .closed = test_case.at("closed")});
    std::size_t k = 0;
    for (const auto& segment : test_case.at("control_points"))
      for (const auto& xy : segment) EXPECT_LT((fit.path.points[k++] - point_of(xy)).norm(), 1e-8);
    const PathFrame frame(PathCurve(fit.path), {-6.0, 6.0});
    const double L = test_case.at("length");
    EXPECT_NEAR(frame.curve().length_m(), L, 1e-8);
    ASSERT_EQ(test_case.at("points").size(), 14U);
    for (const auto& row : test_case.at("points")) {
      const Eigen::Vector2d xy = point_of(row.at("xy")).head<2>();
      const auto found = frame.project(xy);
      ASSERT_TRUE(found.inside());
      EXPECT_LT(frame.curve().distance_along(found.s_m, row.at("s")), 1e-8);
      EXPECT_NEAR(to_paper_sign(found.e_m), row.at("e").get<double>(), 1e-9);
      const PathPoint at = frame.curve().at(found.s_m);
      EXPECT_LT((at.tangent - point_of(row.at("tangent")).head<2>()).norm(), 1e-9);
      EXPECT_NEAR(at.curvature, row.at("curvature").get<double>(), 1e-9);
      const auto back = frame.position(row.at("s"), from_paper_sign(row.at("e")));
      ASSERT_TRUE(back);
      EXPECT_LT((*back - xy).norm(), 1e-8);
    }
    for (const auto& row : test_case.at("outside")) {
      const auto found = frame.project(point_of(row.at("xy")).head<2>());
      const bool at_start = row.at("clamped_s").get<double>() < 0.5 * L;
      EXPECT_EQ(found.status,
                at_start ? ProjectionStatus::kBeforeStart : ProjectionStatus::kBeyondEnd);
    }
  }
}

}  // namespace
}  // namespace roadbook
