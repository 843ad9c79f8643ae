#include "mapping/pipeline/parking_row_prior.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <functional>

#include "base/error.hpp"
#include "base/random.hpp"
#include "tests/mapping/synthetic_bundle.hpp"

namespace roadbook {
namespace {

constexpr double kStep = 2.5;     // [m] of the spaces
constexpr double kAside = 5.5;    // [m] of their middles
constexpr double kDriven = 1.25;  // [m] between poses
constexpr double kHand = 0.03;
constexpr double kHandRad = 0.012;

Matrix6d odometry_information() {
  Vector6d sigma;
  sigma << 0.003, 0.003, 0.003, 0.0005, 0.0005, 0.0005;
  return sigma.cwiseAbs2().cwiseInverse().asDiagonal();
}

Eigen::Isometry3d true_pose(int k) { return pose_from_planar(kDriven * k, 0.0, 0.0); }

// A car that drives straight on past a row; its odometry turns a little with every step.
BundleProblem bent_drive(int poses, double turn_rad) {
  BundleProblem problem;
  Eigen::Isometry3d T = true_pose(0);
  for (int k = 0; k < poses; ++k) {
    problem.poses.push_back({T, false});
    MotionConstraint m{k, k + 1, pose_from_planar(kDriven, 0.0, turn_rad), odometry_information(),
                       -1};
    T = T * m.T_from_to;
    if (k + 1 < poses) problem.motions.push_back(m);
  }
  return problem;
}

// Spaces to the left of the drive. Each space has a drawing error and is tied to the pose next to
// it.
EqualRow drawn_row(int spaces, std::uint64_t seed, double alternating_m = 0.0) {
  Random random(seed, "row");
  EqualRow row;
  for (int i = 0; i < spaces; ++i) {
    const double off = i % 2 == 0 ? alternating_m : -alternating_m;
    const Eigen::Isometry3d T_map_space =
        pose_from_planar(1.0 + kStep * i + off + kHand * random.normal(),
                         kAside + kHand * random.normal(), -M_PI / 2 + kHandRad * random.normal());
    const int pose = 2 * i + 1;
    row.spaces.push_back({i, {{pose, true_pose(pose).inverse() * T_map_space, kHand, kHandRad}}});
  }
  return row;
}

// Returns the distance of the middle pose from the straight line between the first and the last
// pose.
double bow_m(const BundleProblem& problem, int poses) {
  const auto y = [&](int k) {
    return problem.poses[static_cast<std::size_t>(k)].T_map_vehicle.translation().y();
  };
  return std::abs(y(poses / 2) - 0.5 * (y(0) + y(poses - 1)));
}

BundleOptions exact() {
  BundleOptions options;
  options.relative_tolerance = 1e-14;
  options.max_iterations = 100;
  return options;
}

// The reference solves the same drive in the plane. Its unknowns include the line (first point,
// step vector) and the heading of the row. One standard deviation covers both the drawing error and
// the paint error. It uses Gauss-Newton with numeric derivatives.
struct PlanarJudge {
  const BundleProblem& problem;
  const EqualRow& row;
  int poses;

  [[nodiscard]] Eigen::VectorXd residuals(const Eigen::VectorXd& x) const {
    const auto pose = [&](int k) {
      return k == 0 ? Eigen::Vector3d::Zero().eval() : x.segment<3>(3 * (k - 1)).eval();
    };
    const Eigen::VectorXd line = x.tail<5>();
    std::vector<double> r;
    for (int k = 0; k + 1 < poses; ++k) {
      const auto& m = problem.motions[static_cast<std::size_t>(k)];
      const Eigen::Vector3d a = pose(k);
      const Eigen::Vector3d b = pose(k + 1);
      const double turn = heading_of(m.T_from_to);
      const Eigen::Vector2d moved =
          Eigen::Rotation2Dd(-a.z()) * (b - a).head<2>() - m.T_from_to.translation().head<2>();
      const Eigen::Vector2d e = Eigen::Rotation2Dd(-turn) * moved;
      r.insert(r.end(), {e.x() / 0.003, e.y() / 0.003, (b.z() - a.z() - turn) / 0.0005});
    }
    const EqualRowOptions paint;
    for (const RowSpace& space : row.spaces) {
      const SpaceView& view = space.views.front();
      const Eigen::Vector3d p = pose(view.pose);
      const Eigen::Vector2d place =
          p.head<2>() + Eigen::Rotation2Dd(p.z()) * view.T_vehicle_space.translation().head<2>();
      const Eigen::Vector2d e = place - line.head<2>() - space.steps * line.segment<2>(2);
      const double sigma = std::hypot(view.sigma_m, paint.paint_sigma_m);
      const double heading = p.z() + heading_of(view.T_vehicle_space) - line(4);
      r.insert(r.end(), {e.x() / sigma, e.y() / sigma,
                         heading / std::hypot(view.sigma_rad, paint.paint_sigma_rad)});
    }
    return Eigen::Map<Eigen::VectorXd>(r.data(), static_cast<Eigen::Index>(r.size()));
  }

  [[nodiscard]] Eigen::VectorXd solve() const {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(3 * (poses - 1) + 5);
    for (int k = 1; k < poses; ++k) x(3 * (k - 1)) = kDriven * k;
    x.tail<5>() << 1.0, kAside, kStep, 0.0, -M_PI / 2;
    for (int round = 0; round < 6; ++round) {
      Eigen::MatrixXd J(residuals(x).size(), x.size());
      for (Eigen::Index i = 0; i < x.size(); ++i) {
        constexpr double h = 1e-5;
        const Eigen::VectorXd d = h * Eigen::VectorXd::Unit(x.size(), i);
        J.col(i) = (residuals(x + d) - residuals(x - d)) / (2.0 * h);
      }
      x -= (J.transpose() * J).ldlt().solve(J.transpose() * residuals(x));
    }
    return x;
  }
};

TEST(EqualRows, ADriveThatOdometryBendsIsStraightenedByARowAsASolverInThePlaneDoes) {
  constexpr int kPoses = 56;
  BundleProblem problem = bent_drive(kPoses, 2.5e-4);
  const EqualRow row = drawn_row(27, 1);
  const double before = bow_m(problem, kPoses);
  const Eigen::VectorXd judge = PlanarJudge{problem, row, kPoses}.solve();
  EqualRowsUsed used;
  const BundleResult result = bundle_adjust_with_rows(problem, {row}, exact(), {}, used);
  ASSERT_TRUE(result.usable) << result.message;
  EXPECT_EQ(used.rows, 1U);
  EXPECT_EQ(used.spaces, 27U);
  EXPECT_EQ(used.refused, 0U);
  EXPECT_NEAR(before, 2e-4 * 68.75 * 68.75 / 8.0, 0.01);  // curvature of 2e-4 / m
  for (int k = 1; k < kPoses; ++k) {
    const Eigen::Isometry3d& T = problem.poses[static_cast<std::size_t>(k)].T_map_vehicle;
    const Eigen::Vector3d planar = judge.segment<3>(3 * (k - 1));
    // The loose constraints (100 m, 1 rad) weigh 1e-7 of the tight ones. The curvature of the
    // residual itself weighs less.
    ASSERT_NEAR(T.translation().x(), planar.x(), 1e-5) << k;
    ASSERT_NEAR(T.translation().y(), planar.y(), 1e-4) << k;
    ASSERT_NEAR(heading_of(T), planar.z(), 1e-5) << k;
    ASSERT_NEAR(T.translation().z(), 0.0, 1e-6) << k;
  }
  // The remaining bow comes from drawing errors of 3 cm: the standard error of the curvature is
  // 3.7e-5 / m, which gives 2.1 cm of bow.
  EXPECT_LT(bow_m(problem, kPoses), 0.5 * before);
}

TEST(EqualRows, DerivativesOfARowsMotionsAgreeWithFiniteDifferences) {
  BundleProblem problem = bent_drive(24, 1e-3);
  add_equal_rows(problem, {drawn_row(10, 2)});
  ASSERT_EQ(problem.poses.size(), 24U + 12U);
  ASSERT_EQ(problem.motions.size(), 23U + 30U);
  Random random(3, "off the optimum");
  for (std::size_t i = 23; i < problem.motions.size(); ++i) {
    const MotionConstraint& m = problem.motions[i];
    const Eigen::Isometry3d a = problem.poses[static_cast<std::size_t>(m.from)].T_map_vehicle *
                                test::small_motion(0.1, 0.1, random);
    const Eigen::Isometry3d b = problem.poses[static_cast<std::size_t>(m.to)].T_map_vehicle *
                                test::small_motion(0.1, 0.1, random);
    const MotionResidual e = motion_residual(a, b, m.T_from_to, 1.02);
    constexpr double h = 1e-5;
    // h^2 times third derivatives that grow with the longest arm, 25 m; and rounding over h.
    constexpr double kTolerance = 1e-7;
    for (int k = 0; k < 6; ++k) {
      const Vector6d d = h * Vector6d::Unit(k);
      const Vector6d from = (motion_error(a * se3_exp(d), b, m.T_from_to, 1.02) -
                             motion_error(a * se3_exp(-d), b, m.T_from_to, 1.02)) /
                            (2 * h);
      const Vector6d to = (motion_error(a, b * se3_exp(d), m.T_from_to, 1.02) -
                           motion_error(a, b * se3_exp(-d), m.T_from_to, 1.02)) /
                          (2 * h);
      EXPECT_LT((from - e.J_from.col(k)).norm(), kTolerance);
      EXPECT_LT((to - e.J_to.col(k)).norm(), kTolerance);
    }
    const Vector6d scale =
        (motion_error(a, b, m.T_from_to, 1.02 + h) - motion_error(a, b, m.T_from_to, 1.02 - h)) /
        (2 * h);
    EXPECT_LT((scale - e.J_scale).norm(), kTolerance);
  }
}

TEST(EqualRows, ARowThatIsUnequalIsTakenOutAndNothingOfItStays) {
  BundleProblem problem = bent_drive(56, 2.5e-4);
  BundleProblem without = problem;
  EqualRowsUsed used;
  bundle_adjust_with_rows(problem, {drawn_row(27, 4, 0.12)}, exact(), {}, used);
  EXPECT_EQ(used.rows, 0U);
  EXPECT_EQ(used.refused, 1U);
  bundle_adjust(without, exact());
  ASSERT_EQ(problem.poses.size(), without.poses.size());
  for (std::size_t k = 0; k < problem.poses.size(); ++k)
    EXPECT_EQ(problem.poses[k].T_map_vehicle.matrix(), without.poses[k].T_map_vehicle.matrix());
}

TEST(EqualRows, WithoutRowsTheResultIsTheSameToTheBit) {
  test::SyntheticBundle s = test::synthetic_bundle({.length_m = 40.0, .point_count = 200}, 5);
  BundleProblem plain = s.problem;
  EqualRowsUsed used;
  const BundleResult with = bundle_adjust_with_rows(s.problem, {}, {}, {}, used);
  const BundleResult result = bundle_adjust(plain);
  EXPECT_EQ(with.final_cost, result.final_cost);
  for (std::size_t k = 0; k < plain.poses.size(); ++k)
    EXPECT_EQ(s.problem.poses[k].T_map_vehicle.matrix(), plain.poses[k].T_map_vehicle.matrix());
}

// The settings of a map (few iterations, a loose tolerance) would stop with the rows half
// corrected. The adjustment with rows must still converge.
TEST(EqualRows, ALooseEndOfTheMapIsNoneForItsRows) {
  const EqualRow row = drawn_row(27, 1);
  BundleProblem exactly = bent_drive(56, 2.5e-4);
  BundleProblem loosely = exactly;
  EqualRowsUsed used;
  bundle_adjust_with_rows(exactly, {row}, exact(), {}, used);
  BundleOptions loose;
  loose.relative_tolerance = 0.5;
  loose.max_iterations = 1;
  loose.outlier_rounds = 0;
  bundle_adjust_with_rows(loosely, {row}, loose, {}, used);
  EXPECT_EQ(used.rows, 1U);
  for (std::size_t k = 0; k < 56; ++k)
    EXPECT_LT((exactly.poses[k].T_map_vehicle.translation() -
               loosely.poses[k].T_map_vehicle.translation())
                  .norm(),
              1e-4)
        << k;
}

// The second drive is placed 0.3 m too far ahead. The paint that both drives saw shows the error.
TEST(EqualRows, SpacesThatTwoDrivesSawJoinThem) {
  BundleProblem problem = bent_drive(28, 0.0);
  const BundleProblem second = bent_drive(28, 0.0);
  for (const BundlePose& pose : second.poses) {
    problem.poses.push_back(pose);
    problem.poses.back().T_map_vehicle.translation().x() += 0.3;
  }
  for (MotionConstraint m : second.motions) {
    m.from += 28;
    m.to += 28;
    problem.motions.push_back(m);
  }
  EqualRow row = drawn_row(13, 6);
  for (RowSpace& space : row.spaces) {
    SpaceView again = space.views.front();
    again.pose += 28;
    again.sigma_rad = 0.0;
    space.views.push_back(again);
  }
  EqualRowsUsed used;
  const BundleResult result = bundle_adjust_with_rows(problem, {row}, exact(), {}, used);
  ASSERT_TRUE(result.usable) << result.message;
  EXPECT_EQ(used.rows, 1U);
  for (std::size_t k = 0; k < 28; ++k)
    EXPECT_NEAR((problem.poses[k].T_map_vehicle.translation() -
                 problem.poses[28 + k].T_map_vehicle.translation())
                    .norm(),
                0.0, kHand / std::sqrt(13.0));  // the first one is held at its first pose
}

TEST(EqualRows, RowsThatAreNoneAreBadInput) {
  BundleProblem problem = bent_drive(24, 0.0);
  EqualRow row = drawn_row(10, 7);
  row.spaces[4].views.front().pose = 24;
  EXPECT_THROW(add_equal_rows(problem, {row}), BadInput);
  row = drawn_row(10, 7);
  row.spaces[4].steps = 3;
  EXPECT_THROW(add_equal_rows(problem, {row}), BadInput);
  row = drawn_row(2, 7);
  EXPECT_THROW(add_equal_rows(problem, {row}), BadInput);
  EXPECT_THROW(add_equal_rows(problem, {drawn_row(10, 7)}, {.paint_sigma_m = 0.0}), InvalidOption);
}

}  // namespace
}  // namespace roadbook
