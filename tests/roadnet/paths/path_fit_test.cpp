#include "roadnet/paths/path_fit.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <ctime>
#include <numbers>

#include "base/error.hpp"
#include "base/random.hpp"
#include "roadnet/paths/path_fit_within.hpp"
#include "roadnet/paths/path_frame.hpp"
#include "tests/roadnet/test_paths.hpp"
#include "tests/support/real_data.hpp"

namespace roadbook {
namespace {

using test::TwoMileRoad;

void expect_smooth(const BezierPath& path) {
  const JointJumps jumps = joint_jumps(path);
  EXPECT_LT(jumps.position_m, 1e-9);
  EXPECT_LT(jumps.first, 1e-9);
  EXPECT_LT(jumps.second, 1e-9);
}

TEST(PathFit, TwoMilesInFortySegmentsLieWithinFiveCentimetresAndAreSmooth) {
  const auto points = TwoMileRoad::positions(281);
  const std::clock_t begin = std::clock();
  const PathFit fit = fit_path(points, {.segments = 40, .degree = 6});
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  expect_smooth(fit.path);
  const PathCurve curve(fit.path);
  // Against the road itself, at places that were not fitted.
  const auto truth = TwoMileRoad::positions(281 * 7);
  const PathFrame frame(curve, {-6.0, 6.0});
  double worst = 0.0;
  PathCursor cursor;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const auto found = frame.project(truth[i].head<2>(), cursor);
    if (!found.inside()) continue;  // the last centimetres at either end
    worst = std::max(worst, std::abs(found.e_m));
  }
  EXPECT_LT(worst, 0.05);
  EXPECT_NEAR(curve.length_m(), TwoMileRoad::kLength, 0.05);
  RecordProperty("worst_mm", static_cast<int>(1e3 * worst));
  RecordProperty("microseconds", static_cast<int>(1e6 * seconds));
  EXPECT_LT(seconds, 0.1) << "milliseconds are meant";
}

// Solves the same problem literally as in the document: with the continuity as constraints on all
// control points, densely, with Lagrange multipliers.
Eigen::MatrixXd by_multipliers(const std::vector<Eigen::Vector3d>& points,
                               const std::vector<double>& t,
                               double t_end,
                               int M,
                               int n,
                               bool closed) {
  const int unknowns = M * (n + 1);
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(static_cast<int>(points.size()), unknowns);
  Eigen::MatrixXd b(static_cast<int>(points.size()), 2);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double at = t[i] / t_end * M;
    const int segment = std::min(static_cast<int>(at), M - 1);
    const double u = at - segment;
    for (int k = 0; k <= n; ++k)
      A(static_cast<int>(i), segment * (n + 1) + k) =
          std::tgamma(n + 1) / (std::tgamma(k + 1) * std::tgamma(n - k + 1)) * std::pow(u, k) *
          std::pow(1.0 - u, n - k);
    b.row(static_cast<int>(i)) = points[i].head<2>().transpose();
  }
  const int joints = closed ? M : M - 1;
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(3 * joints, unknowns);
  for (int j = 0; j < joints; ++j) {
    const int e = j * (n + 1) + n;          // end of the segment before
    const int s = ((j + 1) % M) * (n + 1);  // start of the one after
    C(3 * j, e) = 1.0;
    C(3 * j, s) = -1.0;
    for (const auto& [at, sign] : {std::pair{e - 1, -1.0}, {e, 1.0}, {s, 1.0}, {s + 1, -1.0}})
      C(3 * j + 1, at) += sign;
    for (const auto& [at, sign] :
         {std::pair{e - 2, 1.0}, {e - 1, -2.0}, {e, 1.0}, {s, -1.0}, {s + 1, 2.0}, {s + 2, -1.0}})
      C(3 * j + 2, at) += sign;
  }
  const auto constraints = C.rows();
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(unknowns + constraints, unknowns + constraints);
  K.topLeftCorner(unknowns, unknowns) = A.transpose() * A;
  K.topRightCorner(unknowns, constraints) = C.transpose();
  K.bottomLeftCorner(constraints, unknowns) = C;
  Eigen::MatrixXd rhs = Eigen::MatrixXd::Zero(unknowns + constraints, 2);
  rhs.topRows(unknowns) = A.transpose() * b;
  return K.fullPivLu().solve(rhs).topRows(unknowns);
}

TEST(PathFit, EqualsTheConstrainedProblemSolvedWithMultipliers) {
  for (const bool closed : {false, true}) {
    for (int degree = kMinPathDegree; degree <= 7; ++degree) {
      SCOPED_TRACE(::testing::Message() << "degree " << degree << " closed " << closed);
      const int M = 5;
      const auto points = test::ring(90);
      std::vector<double> t;
      const double t_end = 100.0;
      Random random(static_cast<std::uint64_t>(degree));
      for (int i = 0; i < 90; ++i) t.push_back(t_end * (i + random.uniform(0.0, 0.5)) / 90.0);
      const PathFit fit =
          fit_path(points, t, t_end, {.segments = M, .degree = degree, .closed = closed});
      const auto expected = by_multipliers(points, t, t_end, M, degree, closed);
      expect_smooth(fit.path);
      // The dense system has a condition of about 1e9 times rounding of 100 m: 1e-5 to be wide; a
      // wrong continuity or a wrong joint is metres off.
      for (int k = 0; k < M * (degree + 1); ++k)
        EXPECT_LT(
            (fit.path.points[static_cast<std::size_t>(k)].head<2>() - expected.row(k).transpose())
                .norm(),
            1e-6);
    }
  }
}

TEST(PathFit, APolynomialOfItsDegreeIsFoundExactly) {
  for (int degree = kMinPathDegree; degree <= kMaxPathDegree; ++degree) {
    std::vector<Eigen::Vector3d> points;
    std::vector<double> t;
    const auto curve = [degree](double at) {
      return Eigen::Vector3d(100.0 * at, 30.0 * std::pow(at, degree) - 10.0 * at * at, at);
    };
    for (int i = 0; i <= 100; ++i) {
      t.push_back(0.01 * i);
      points.push_back(curve(t.back()));
    }
    const PathFit fit = fit_path(points, t, 1.0, {.segments = 4, .degree = degree});
    expect_smooth(fit.path);
    // Normal equations square the condition of the basis (1e3 at degree 9), times rounding of 100
    // m.
    EXPECT_LT(fit.max_deviation_m, 1e-8) << "degree " << degree;
  }
}

TEST(PathFit, PinnedEndsAreMetExactlyWhateverTheNoise) {
  auto points = TwoMileRoad::positions(300);
  Random random(7);
  for (auto& p : points) p += Eigen::Vector3d(random.normal(), random.normal(), 0.0);
  const PathFit fit = fit_path(points, {.segments = 20, .pin_ends = true});
  EXPECT_EQ(fit.path.points.front(), points.front());
  EXPECT_EQ(fit.path.points.back(), points.back());
  expect_smooth(fit.path);
}

// A wave on a straight line: of the length named it is halved; half as long, divided by 65 (the
// penalty grows with the sixth power); four times as long, kept but for 1 / 4097.
TEST(PathFit, SmoothingHalvesAWaveOfTheLengthNamed) {
  const double named = 10.0;
  for (const auto& [wavelength, kept] :
       {std::pair{10.0, 0.5}, {5.0, 1.0 / 65.0}, {40.0, 4096.0 / 4097.0}}) {
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i <= 800; ++i) {
      const double x = 0.25 * i;
      // Parameters are x itself: the amplitude adds nothing to the chords that matters.
      points.emplace_back(x, 0.001 * std::cos(2.0 * std::numbers::pi * x / wavelength), 0.0);
    }
    const PathFit fit = fit_path(points, {.segments = 100, .smooth_below_m = named});
    const PathCurve curve(fit.path);
    // Away from the ends, at a crest near the middle.
    const double crest = wavelength * std::round(100.0 / wavelength);
    EXPECT_NEAR(curve.at(crest).position.y(), 0.001 * kept, 0.00002) << wavelength;
  }
}

TEST(PathFit, RealTracksAreFollowedWithinFiveCentimetres) {
  ROADBOOK_REQUIRE_DATA(folder, "racetracks_friction");
  for (const char* name : test::kTracks) {
    SCOPED_TRACE(name);
    const auto points = test::track_centre(folder, name);
    ASSERT_GT(points.size(), 400U);
    // Points are 5 m apart, so they cannot represent features shorter than 10 m. Some bends begin
    // and end between two points, and segments of 15 m follow these bends.
    const int segments = static_cast<int>(points.size()) / 3;
    const PathFit fit =
        fit_path(points, {.segments = segments, .closed = true, .smooth_below_m = 10.0});
    expect_smooth(fit.path);
    EXPECT_LT(fit.max_deviation_m, 0.05) << "rms " << fit.rms_m << " point " << fit.worst_point;
    double chords = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i)
      chords += (points[(i + 1) % points.size()] - points[i]).norm();
    // Chords are shorter than arcs: by k^2 c^3 / 24 each, 1e-4 of the length in a bend of 50 m.
    const PathCurve curve(fit.path);
    EXPECT_GT(curve.length_m(), chords - 0.1);
    EXPECT_LT(curve.length_m(), chords * 1.001);
    std::printf("%-14s %d segments, rms %.4f m, worst %.4f m, tightest %.1f m\n", name, segments,
                fit.rms_m, fit.max_deviation_m,
                1.0 / std::abs(curvature_peak(curve, 0.0, curve.length_m(), 1.0).curvature));
  }
}

// The permitted error determines the number of segments, not the reverse.
TEST(PathFit, AsManySegmentsAsATargetNeeds) {
  std::vector<Eigen::Vector3d> hairpin;  // 60 m straight, a half circle of 10 m, 60 m back
  for (double x = 0.0; x < 60.0; x += 1.0) hairpin.emplace_back(x, 0.0, 0.0);
  for (double a = 0.0; a < std::numbers::pi; a += 0.1)
    hairpin.emplace_back(60.0 + 10.0 * std::sin(a), 10.0 - 10.0 * std::cos(a), 0.0);
  for (double x = 60.0; x >= 0.0; x -= 1.0) hairpin.emplace_back(x, 20.0, 0.0);
  const PathFit rough = fit_path_within(hairpin, 0.5, {.segments = 1});
  const PathFit fine = fit_path_within(hairpin, 0.05, {.segments = 1});
  EXPECT_LE(rough.max_deviation_m, 0.5);
  EXPECT_LE(fine.max_deviation_m, 0.05);
  EXPECT_LT(rough.path.segments(), fine.path.segments());
  EXPECT_GT(fit_path(hairpin, {.segments = rough.path.segments()}).max_deviation_m, 0.05);
  // If no number of segments reaches the bound, the fit reports its deviation.
  const PathFit best = fit_path_within(hairpin, 1e-9, {.segments = 1});
  EXPECT_GT(best.max_deviation_m, 1e-9);
  EXPECT_LE(best.max_deviation_m, fine.max_deviation_m);
  EXPECT_THROW(fit_path_within(hairpin, 0.0), InvalidOption);
}

template <typename Call>
std::string refusal(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(PathFit, BadInputIsRefusedAndItsPlaceNamed) {
  auto points = TwoMileRoad::positions(100);
  EXPECT_NE(refusal([&] { (void)fit_path({points[0]}); }).find("path points: got 1"),
            std::string::npos);
  auto twice = points;
  twice[41] = twice[40];
  EXPECT_NE(refusal([&] { (void)fit_path(twice, {.segments = 5}); }).find("points 40 and 41"),
            std::string::npos);
  auto broken = points;
  broken[17].x() = std::nan("");
  EXPECT_NE(refusal([&] { (void)fit_path(broken, {.segments = 5}); }).find("point 17"),
            std::string::npos);
  EXPECT_NE(refusal([&] { (void)fit_path(points, {.segments = 40}); }).find("fewer than 40"),
            std::string::npos);
  EXPECT_NE(refusal([&] { (void)fit_path(points, {.segments = 0}); }).find("segments"),
            std::string::npos);
  EXPECT_NE(refusal([&] { (void)fit_path(points, {.degree = 2}); }).find("degree"),
            std::string::npos);
  EXPECT_NE(refusal([&] {
              (void)fit_path(points, {.segments = 5, .closed = true, .pin_ends = true});
            }).find("pin_ends"),
            std::string::npos);
}

}  // namespace
}  // namespace roadbook
