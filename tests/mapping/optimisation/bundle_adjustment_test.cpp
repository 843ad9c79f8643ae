#include "mapping/optimisation/bundle_adjustment.hpp"

#include <ceres/ceres.h>
#include <ceres/rotation.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>

#include "base/error.hpp"
#include "mapping/optimisation/bundle_adjustment_terms.hpp"
#include "mapping/similarity.hpp"
#include "tests/mapping/synthetic_bundle.hpp"
#include "tests/support/real_data.hpp"

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

TEST(BundleAdjustment, BothSolversFindTheSameMinimum) {
  for (const RobustLoss loss : {RobustLoss::kNone, RobustLoss::kHuber, RobustLoss::kCauchy}) {
    SCOPED_TRACE(static_cast<int>(loss));
    SyntheticBundle own =
        test::synthetic_bundle({.length_m = 60.0, .point_count = 800, .wheel_error = 0.01}, 8);
    Random random(8, "outliers");
    for (BundleObservation& o : own.problem.observations)
      if (random.uniform() < 0.02) o.pixel.x() += random.uniform(-20.0, 20.0);
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

// BAL's camera looks along -z. A half turn about x makes it roadbook's camera; the pixel's y
// changes its sign.
struct Bal {
  BundleProblem problem;
};
Bal read_bal(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::size_t cameras = 0, points = 0, observations = 0;
  in >> cameras >> points >> observations;
  Bal bal;
  for (std::size_t i = 0; i < observations; ++i) {
    BundleObservation o;
    in >> o.pose >> o.point >> o.pixel.x() >> o.pixel.y();
    o.pixel.y() = -o.pixel.y();
    o.camera = o.pose;
    bal.problem.observations.push_back(o);
  }
  const Eigen::Matrix3d flip = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  for (std::size_t i = 0; i < cameras; ++i) {
    Vector6d pose;
    double f = 0, k1 = 0, k2 = 0;
    for (int k = 0; k < 6; ++k) in >> pose(k);
    in >> f >> k1 >> k2;
    Eigen::Isometry3d T_camera_map = Eigen::Isometry3d::Identity();
    T_camera_map.linear() = flip * so3_exp(pose.head<3>());
    T_camera_map.translation() = flip * pose.tail<3>();
    bal.problem.poses.push_back({T_camera_map.inverse(), false});
    MountedCamera mounted;
    mounted.camera.parameters = {f, f, 0.0, 0.0, k1, k2, 0.0, 0.0, 0.0};
    mounted.camera.width = mounted.camera.height = 4000;
    bal.problem.cameras.push_back(mounted);
  }
  bal.problem.points.resize(points);
  for (BundlePoint& point : bal.problem.points)
    in >> point.p_map.x() >> point.p_map.y() >> point.p_map.z();
  return bal;
}

// BAL's camera model by its definition, with automatic derivatives.
struct BalResidual {
  Eigen::Vector2d pixel;
  std::array<double, 3> intrinsics;
  template <typename T>
  bool operator()(const T* pose, const T* point, T* residual) const {
    T p[3];
    ceres::AngleAxisRotatePoint(pose, point, p);
    for (int i = 0; i < 3; ++i) p[i] += pose[3 + i];
    const T x = -p[0] / p[2];
    const T y = -p[1] / p[2];
    const T r2 = x * x + y * y;
    const T d = intrinsics[0] * (1.0 + r2 * (intrinsics[1] + intrinsics[2] * r2));
    residual[0] = d * x - pixel.x();
    residual[1] = d * y + pixel.y();
    return true;
  }
};

double ceres_cost(const BundleProblem& problem) {
  const Eigen::Matrix3d flip = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  std::vector<Vector6d> poses;
  for (const BundlePose& pose : problem.poses) {
    const Eigen::Isometry3d T = pose.T_map_vehicle.inverse();
    Vector6d x;
    x << so3_log(flip * T.linear()), flip * T.translation();
    poses.push_back(x);
  }
  std::vector<Eigen::Vector3d> points;
  for (const BundlePoint& point : problem.points) points.push_back(point.p_map);
  ceres::Problem judge;
  for (const BundleObservation& o : problem.observations) {
    const auto& k = problem.cameras[static_cast<std::size_t>(o.camera)].camera.parameters;
    judge.AddResidualBlock(new ceres::AutoDiffCostFunction<BalResidual, 2, 6, 3>(
                               new BalResidual{o.pixel, {k[0], k[4], k[5]}}),
                           nullptr, poses[static_cast<std::size_t>(o.pose)].data(),
                           points[static_cast<std::size_t>(o.point)].data());
  }
  judge.SetParameterBlockConstant(poses[0].data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_SCHUR;
  options.max_num_iterations = 100;
  options.function_tolerance = 1e-8;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &judge, &summary);
  std::printf("ladybug: Ceres %.6e -> %.6e in %d steps, %.2f s\n", summary.initial_cost,
              summary.final_cost, summary.num_successful_steps, summary.total_time_in_seconds);
  return summary.final_cost;
}

TEST(BundleAdjustment, BothSolversReachTheCostOfBalsOwnResidualsOnTheLadybugProblem) {
  ROADBOOK_REQUIRE_DATA(folder, "bal_ladybug49");
  Bal bal = read_bal(folder / "problem-49-7776-pre.txt");
  // Some pixels lie beyond the maximum of their camera's distortion polynomial. Our camera model
  // does not project there.
  const std::size_t all = bal.problem.observations.size();
  std::erase_if(bal.problem.observations, [&](const BundleObservation& o) {
    const BundlePose& pose = bal.problem.poses[static_cast<std::size_t>(o.pose)];
    const BundlePoint& point = bal.problem.points[static_cast<std::size_t>(o.point)];
    return !term_residual(bal.problem, {o.pose, o.camera, -1, o.pixel, 1.0}, pose.T_map_vehicle,
                          point.p_map, false)
                .valid;
  });
  EXPECT_GT(bal.problem.observations.size(), all - all / 500);
  std::printf("ladybug: %zu of %zu observations\n", bal.problem.observations.size(), all);
  const double judged = ceres_cost(bal.problem);
  BundleOptions options;
  options.loss = RobustLoss::kNone;
  options.outlier_rounds = 0;
  options.max_iterations = 100;
  options.relative_tolerance = 1e-8;
  for (const LeastSquaresSolver solver : {LeastSquaresSolver::kOwn, LeastSquaresSolver::kCeres}) {
    options.solver = solver;
    BundleProblem problem = bal.problem;
    const auto begin = std::chrono::steady_clock::now();
    const BundleResult result = bundle_adjust(problem, options);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    std::printf("ladybug: %s %.6e -> %.6e in %d steps, %.2f s\n",
                solver == LeastSquaresSolver::kOwn ? "own  " : "ceres", result.initial_cost,
                result.final_cost, result.iterations, seconds.count());
    EXPECT_TRUE(result.usable);
    EXPECT_LT(result.final_cost, 1.01 * judged);
  }
}

}  // namespace
}  // namespace roadbook
