#include "mapping/occupancy/range_map.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "base/random.hpp"
#include "diagnosis/logs/plain_matrix.hpp"
#include "diagnosis/numerics/place_basis.hpp"
#include "diagnosis/numerics/sequential_projection.hpp"
#include "diagnosis/range/range_readings.hpp"
#include "tests/diagnosis/range_corridor.hpp"
#include "tests/support/real_data.hpp"

namespace roadbook {
namespace {

using test::corridor;

TEST(RangeMap, ExpectsOfABeamWhatGeometrySaysThoughItReadSomethingElse) {
  std::vector<RangeBeam> beams = corridor();
  Random random(2);
  std::vector<double> truth;
  for (RangeBeam& b : beams) {
    truth.push_back(b.range_m);
    if (random.uniform() < 0.1) b.range_m *= random.uniform();  // short
  }
  const RangeMap map(beams, 25.0);
  double known = 0.0, off = 0.0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const auto expected = map.surface(beams[i]);
    if (!expected) continue;
    known += 1.0;
    off += std::abs(expected->range_m - truth[i]) >
           0.06;  // noise of 0.01 m, line through cells of 0.1 m
  }
  EXPECT_GT(known, 0.4 * static_cast<double>(beams.size()));
  EXPECT_LT(off, 0.01 * known);
}

// A corridor along x, walls at y = 0 and 4: the way to a wall is 2 / |sin a|, shorter by
// 1 / |sin a| per metre towards it, and a turn changes the angle a.
TEST(RangeReadings, SayHowTheExpectedRangeChangesWithThePose) {
  std::vector<RangeBeam> beams = corridor();
  const RangeReadings readings = expect_ranges(beams, 25.0);
  std::size_t looked_at = 0;
  for (const ExpectedRange& r : readings.samples) {
    const RangeBeam& b = beams[60 * static_cast<std::size_t>(std::lround(10.0 * r.t_s)) + r.beam];
    const double sine = b.along.y(), cosine = b.along.x();
    if (std::abs(sine) < 0.5 || r.expected_m > 4.5) continue;
    ++looked_at;
    const double side = sine > 0.0 ? 1.0 : -1.0;
    EXPECT_NEAR(r.by_pose.x(), 0.0, 0.2);  // the line through noisy ends is off by degrees
    EXPECT_NEAR(r.by_pose.y(), -1.0 / sine, 0.2);
    EXPECT_NEAR(r.by_pose.z(), -side * 2.0 * cosine / (sine * sine), 0.5);
  }
  EXPECT_GT(looked_at, 1000U);
}

// The car's front dips: the scanner sees the floor below the surface that level beams hit.
TEST(RangeMap, ExpectsNothingOfABeamAtAnotherHeightThanThoseThatMetTheSurface) {
  const std::vector<RangeBeam> beams = corridor();
  const RangeMap map(beams, 25.0);
  std::size_t level = 0, dipped = 0;
  for (std::size_t i = 0; i < beams.size(); i += 7) {
    RangeBeam b = beams[i];
    if (b.range_m < 6.0) continue;
    level += map.surface(b).has_value() ? 1U : 0U;
    b.climb = -0.04;  // 0.24 m lower after 6 m
    dipped += map.surface(b).has_value() ? 1U : 0U;
  }
  EXPECT_GT(level, 100U);
  EXPECT_EQ(dipped, 0U);
}

// Kalman innovations against the definition: residuals of a joint Gaussian, factored.
TEST(SequentialProjection, LeavesTheInnovationsOfTheJointDistribution) {
  Random random(4);
  Eigen::MatrixXd A(12, 3);
  Eigen::VectorXd y(12);
  for (Eigen::Index i = 0; i < 12; ++i) {
    for (Eigen::Index k = 0; k < 3; ++k) A(i, k) = random.normal();
    y[i] = random.normal();
  }
  const Eigen::Vector3d prior(4.0, 1.0, 0.5);
  const Eigen::MatrixXd S =
      A * prior.asDiagonal() * A.transpose() + Eigen::MatrixXd::Identity(12, 12);
  const Eigen::LLT<Eigen::MatrixXd> factor(S);
  const Eigen::VectorXd want = factor.matrixL().solve(y);
  SequentialProjection projection(prior, 1);
  for (Eigen::Index i = 0; i < 12; ++i) {
    Eigen::RowVectorXd side = y.segment(i, 1).transpose();
    projection.next(A.row(i).transpose(), side);
    EXPECT_NEAR(side[0], want[i], 1e-12);
  }
}

TEST(PlaceBasis, HasTheCovarianceOfTheProcess) {
  std::vector<Eigen::Vector2d> places;
  for (int i = 0; i < 60; ++i) places.emplace_back(2.0 * i + 1.0, 0.0);
  const PlaceCells cells = place_cells(places);
  const Eigen::MatrixXd basis = place_basis(cells, 20.0, 60);
  const Eigen::MatrixXd K = basis * basis.transpose();
  for (int d : {0, 3, 10}) {
    const double r = std::sqrt(3.0) * 2.0 * d / 20.0;
    EXPECT_NEAR(K(20, 20 + d), (1.0 + r) * std::exp(-r), 0.03);  // the smallest terms are left out
  }
}

TEST(PlainMatrix, AMatlabFileIsATableAndAnythingElseAFault) {
  ROADBOOK_REQUIRE_DATA(data, "plaza_mower");
  ProblemList problems;
  const LogTable beacons = read_matrix_table(data / "Plaza1_.mat", "TL", problems);
  ASSERT_EQ(beacons.rows.size(), 4U);
  // As scipy reads it.
  EXPECT_EQ(numbers_of(beacons, {"2", "x"}, problems)[1], 11.036123999976553);
  EXPECT_FALSE(problems.has_errors());
  (void)read_matrix_table(data / "Plaza1_.mat", "XX", problems);
  (void)read_matrix_table(data / "README.txt", "TL", problems);
  EXPECT_EQ(problems.error_count(), 2U);
}

}  // namespace
}  // namespace roadbook
