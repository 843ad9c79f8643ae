#include <ceres/ceres.h>
#include <ceres/rotation.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <fstream>

#include "mapping/optimisation/bundle_adjustment.hpp"
#include "mapping/optimisation/bundle_adjustment_terms.hpp"
#include "tests/support/real_data.hpp"

// Bundle adjustment of a problem of BAL (Agarwal et al., Bundle Adjustment in the Large, ECCV
// 2010).

namespace roadbook {
namespace {

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
