#include "mapping/optimisation/bundle_adjustment.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.hpp"
#include "mapping/optimisation/bundle_adjustment_terms.hpp"
#include "mapping/similarity.hpp"
#include "tests/mapping/synthetic_bundle.hpp"

namespace roadbook {
namespace {

using test::SyntheticBundle;
using test::SyntheticOptions;

TrajectoryError ate(const SyntheticBundle& s) {
  std::vector<Eigen::Vector3d> truth;
  std::vector<Eigen::Vector3d> estimate;
  for (std::size_t i = 0; i < s.poses.size(); ++i) {
    truth.emplace_back(s.poses[i].translation());
    estimate.emplace_back(s.problem.poses[i].T_map_vehicle.translation());
  }
  return trajectory_error(truth, estimate, false);
}

double landmark_median_m(const SyntheticBundle& s, const BundleResult& result) {
  const Similarity aligned = ate(s).T_reference_estimate;
  std::vector<double> errors;
  for (std::size_t p = 0; p < s.points.size(); ++p)
    if (result.point_kept[p] != 0)
      errors.push_back((s.points[p] - aligned * s.problem.points[p].p_map).norm());
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2),
                   errors.end());
  return errors[errors.size() / 2];
}

TEST(BundleAdjustment, JacobiansOfPixelsAndGroundHeightsAgreeWithFiniteDifferences) {
  const SyntheticBundle s = test::synthetic_bundle({.length_m = 20.0, .point_count = 40}, 1);
  std::size_t checked = 0;
  for (const BundleObservation& o : s.problem.observations) {
    for (const int camera : {o.camera, BundleTerm::kGround}) {
      const BundleTerm term{o.pose, camera, -1, o.pixel, 1.0 / o.sigma_px};
      const Eigen::Isometry3d T = s.problem.poses[static_cast<std::size_t>(o.pose)].T_map_vehicle;
      const Eigen::Vector3d p = s.points[static_cast<std::size_t>(o.point)];
      const TermResidual e = term_residual(s.problem, term, T, p, true);
      ASSERT_TRUE(e.valid);
      constexpr double h = 1e-6;
      const double tolerance = 1e-5 * (1.0 + e.J_pose.norm());  // h^2 times the third derivative
      for (int i = 0; i < 6; ++i) {
        const Vector6d d = h * Vector6d::Unit(i);
        const Eigen::Vector2d J = (term_residual(s.problem, term, T * se3_exp(d), p, false).r -
                                   term_residual(s.problem, term, T * se3_exp(-d), p, false).r) /
                                  (2 * h);
        EXPECT_LT((J - e.J_pose.col(i)).norm(), tolerance);
      }
      for (int i = 0; i < 3; ++i) {
        const Eigen::Vector3d d = h * Eigen::Vector3d::Unit(i);
        const Eigen::Vector2d J = (term_residual(s.problem, term, T, p + d, false).r -
                                   term_residual(s.problem, term, T, p - d, false).r) /
                                  (2 * h);
        EXPECT_LT((J - e.J_point.col(i)).norm(), tolerance);
      }
    }
    if (++checked == 100) break;
  }
  EXPECT_GT(checked, 20u);
}

TEST(BundleAdjustment, RecoversALoopOf200MetresFromFourFisheyes) {
  SyntheticBundle s = test::synthetic_bundle({}, 2);
  BundleOptions options;
  options.loss = RobustLoss::kNone;
  options.outlier_rounds = 0;
  const BundleResult result = bundle_adjust(s.problem, options);
  ASSERT_TRUE(result.usable) << result.message;
  EXPECT_TRUE(result.converged);
  // The rms per degree of freedom estimates the injected noise. With n degrees of freedom, its
  // relative standard error is 1 / sqrt(2 n).
  const double values = 2.0 * static_cast<double>(s.problem.observations.size());
  const double sigma = result.reprojection_rms_px *
                       std::sqrt(values / static_cast<double>(result.degrees_of_freedom));
  EXPECT_NEAR(sigma, 0.5, 0.05 * 0.5);
  EXPECT_LT(ate(s).median_m, 0.05);
  EXPECT_LT(landmark_median_m(s, result), 0.05);
}

TEST(BundleAdjustment, FindsWheelsThatAreWrongByOnePercentFromTheGround) {
  SyntheticBundle s = test::synthetic_bundle({.wheel_error = 0.01}, 3);
  const BundleResult result = bundle_adjust(s.problem);
  ASSERT_TRUE(result.usable);
  EXPECT_NEAR(s.problem.scales[0].value, 1.01, 0.002);
  EXPECT_LT(ate(s).median_m, 0.05);
}

TEST(BundleAdjustment, TenPercentOutliersDoNoHarm) {
  SyntheticBundle s = test::synthetic_bundle({}, 4);
  Random random(4, "outliers");
  std::vector<std::uint8_t> spoiled(s.problem.observations.size(), 0);
  for (std::size_t o = 0; o < spoiled.size(); ++o) {
    if (random.uniform() >= 0.1) continue;
    spoiled[o] = 1;
    s.problem.observations[o].pixel +=
        Eigen::Vector2d(random.uniform(-60, 60), random.uniform(-60, 60));
  }
  const BundleResult result = bundle_adjust(s.problem);
  ASSERT_TRUE(result.usable);
  EXPECT_LT(ate(s).median_m, 0.05);
  EXPECT_LT(landmark_median_m(s, result), 0.05);
  std::size_t kept_outliers = 0;
  std::size_t lost_inliers = 0;
  for (std::size_t o = 0; o < spoiled.size(); ++o) {
    kept_outliers += spoiled[o] != 0 && result.inlier[o] != 0;
    lost_inliers += spoiled[o] == 0 && result.inlier[o] == 0;
  }
  // An outlier within the gate (4.3 sigma = 2.1 px of 60) is not distinguishable from a
  // measurement. The probability is 0.4 %.
  EXPECT_LT(static_cast<double>(kept_outliers), 0.01 * 0.1 * static_cast<double>(spoiled.size()));
  EXPECT_LT(static_cast<double>(lost_inliers), 0.01 * static_cast<double>(spoiled.size()));
}

TEST(BundleAdjustment, DropsObservationsThatNoCameraCanMakeAndPointsSeenOnce) {
  SyntheticBundle s = test::synthetic_bundle({.length_m = 40.0, .point_count = 300}, 5);
  for (MountedCamera& camera : s.problem.cameras) camera.camera.max_angle_rad = 1.5;
  BundleObservation impossible = s.problem.observations[0];
  impossible.camera = (impossible.camera + 2) % 4;  // the camera that looks the other way
  s.problem.observations.push_back(impossible);
  s.problem.points.push_back({Eigen::Vector3d(1.0, 2.0, 3.0), false, -1, false});
  impossible = s.problem.observations[1];
  impossible.point = static_cast<int>(s.problem.points.size()) - 1;
  s.problem.observations.push_back(impossible);
  const BundleResult result = bundle_adjust(s.problem);
  EXPECT_TRUE(result.usable);
  EXPECT_EQ(result.inlier[s.problem.observations.size() - 2], 0);
  EXPECT_EQ(result.inlier.back(), 0);
  EXPECT_EQ(result.point_kept.back(), 0);
  EXPECT_EQ(s.problem.points.back().p_map, Eigen::Vector3d(1.0, 2.0, 3.0));
}

TEST(BundleAdjustment, GivesTheSameBytesOnOneAndTwoThreads) {
  SyntheticBundle a = test::synthetic_bundle({.wheel_error = 0.01}, 6);
  SyntheticBundle b = a;
  (void)bundle_adjust(a.problem, {.num_threads = 1});
  (void)bundle_adjust(b.problem, {.num_threads = 2});
  for (std::size_t i = 0; i < a.poses.size(); ++i)
    ASSERT_EQ(a.problem.poses[i].T_map_vehicle.matrix(), b.problem.poses[i].T_map_vehicle.matrix());
  for (std::size_t p = 0; p < a.points.size(); ++p)
    ASSERT_EQ(a.problem.points[p].p_map, b.problem.points[p].p_map);
  ASSERT_EQ(a.problem.scales[0].value, b.problem.scales[0].value);
}

// Largest distance between the poses of two solutions [m], and angle [rad].
std::pair<double, double> pose_difference(const BundleProblem& a, const BundleProblem& b) {
  std::pair<double, double> largest{0.0, 0.0};
  for (std::size_t i = 0; i < a.poses.size(); ++i) {
    const Eigen::Isometry3d T = a.poses[i].T_map_vehicle.inverse() * b.poses[i].T_map_vehicle;
    largest.first = std::max(largest.first, T.translation().norm());
    largest.second = std::max(largest.second, so3_log(T.linear()).norm());
  }
  return largest;
}

// The wheels stand for six motions of 1 m: 100 standard deviations. A quadratic cost bends the loop
// by it; with Huber's, the false motions pull like six at 5.3 sigma.
TEST(BundleAdjustment, FalseMotionsDoNotBendTheMap) {
  const auto error_with = [](bool standing, double motion_loss_width) {
    SyntheticBundle s = test::synthetic_bundle({.point_count = 1000}, 12);
    for (std::size_t i = 80; standing && i < 86; ++i)
      s.problem.motions[i].T_from_to = Eigen::Isometry3d::Identity();
    BundleOptions options;
    options.motion_loss_width = motion_loss_width;
    EXPECT_TRUE(bundle_adjust(s.problem, options).usable);
    return ate(s).p95_m;
  };
  const double sound_m = error_with(false, BundleOptions().motion_loss_width);
  EXPECT_LT(error_with(true, BundleOptions().motion_loss_width), 1.5 * sound_m);
  EXPECT_GT(error_with(true, 1e9), 3.0 * sound_m);
}

TEST(BundleAdjustment, BothSolversFindTheSameMinimum) {
  for (const RobustLoss loss : {RobustLoss::kNone, RobustLoss::kHuber, RobustLoss::kCauchy}) {
    SCOPED_TRACE(static_cast<int>(loss));
    SyntheticBundle own =
        test::synthetic_bundle({.length_m = 40.0, .point_count = 400, .wheel_error = 0.01}, 8);
    Random random(8, "outliers");
    for (BundleObservation& o : own.problem.observations)
      if (random.uniform() < 0.02) o.pixel.x() += random.uniform(-20.0, 20.0);
    own.problem.motions[20].T_from_to.translation() *= 1.1;  // ten standard deviations
    Matrix6d heading_only = Matrix6d::Zero();  // a prior that says nothing of the position
    heading_only(5, 5) = 1e4;
    own.problem.priors.push_back({3, own.poses[3], heading_only});
    own.problem.poses[0].fixed = true;
    SyntheticBundle ceres = own;
    BundleOptions options;
    options.loss = loss;
    options.max_iterations = 100;
    options.relative_tolerance = 1e-12;
    const BundleResult a = bundle_adjust(own.problem, options);
    options.solver = LeastSquaresSolver::kCeres;
    const BundleResult b = bundle_adjust(ceres.problem, options);
    ASSERT_TRUE(a.usable && b.usable);
    EXPECT_NEAR(a.initial_cost, b.initial_cost, 1e-12 * a.initial_cost);
    EXPECT_NEAR(a.final_cost, b.final_cost, 1e-6 * a.final_cost);
    EXPECT_EQ(a.inlier, b.inlier);
    const auto [metres, radians] = pose_difference(own.problem, ceres.problem);
    EXPECT_LT(metres, 1e-4);
    EXPECT_LT(radians, 1e-5);
    EXPECT_NEAR(own.problem.scales[0].value, ceres.problem.scales[0].value, 1e-6);
    EXPECT_LT(ate(ceres).median_m, 0.05);
  }
}

TEST(BundleAdjustment, CeresGivesTheSameBytesOnAnyNumberOfThreads) {
  const SyntheticBundle start = test::synthetic_bundle({.length_m = 40.0, .point_count = 300}, 9);
  std::vector<BundleProblem> problems;
  for (const int threads : {1, 2, 4}) {
    problems.push_back(start.problem);
    (void)bundle_adjust(problems.back(),
                        {.solver = LeastSquaresSolver::kCeres, .num_threads = threads});
  }
  for (const BundleProblem& other : problems)
    for (std::size_t i = 0; i < other.poses.size(); ++i)
      ASSERT_EQ(problems[0].poses[i].T_map_vehicle.matrix(), other.poses[i].T_map_vehicle.matrix());
}

TEST(BundleAdjustment, CeresStopsWhenProgressAsksForIt) {
  SyntheticBundle s = test::synthetic_bundle({.length_m = 40.0, .point_count = 300}, 9);
  const BundleOptions options{.solver = LeastSquaresSolver::kCeres};
  EXPECT_THROW(bundle_adjust(s.problem, options, [](auto, auto done, auto) { return done < 1; }),
               Interrupted);
}

TEST(BundleAdjustment, RefusesWhatCannotBeUsed) {
  SyntheticBundle s = test::synthetic_bundle({.length_m = 20.0, .point_count = 40}, 7);
  s.problem.observations[0].pose = 1000;
  EXPECT_THROW(bundle_adjust(s.problem), BadInput);
  s.problem.observations[0].pose = 0;
  s.problem.poses[1].T_map_vehicle(0, 3) = std::nan("");
  EXPECT_THROW(bundle_adjust(s.problem), BadInput);
  EXPECT_THROW(bundle_adjust(s.problem, {.max_iterations = 0}), InvalidOption);
}

}  // namespace
}  // namespace roadbook
