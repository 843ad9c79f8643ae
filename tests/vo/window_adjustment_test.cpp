#include "vo/window/window_adjustment.hpp"

#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "base/random.hpp"
#include "tests/support/fisheye_rig.hpp"
#include "tests/vo/synthetic_views.hpp"
#include "vo/window/driving_prior.hpp"

namespace roadbook {
namespace {

constexpr int kPoses = 8;
constexpr int kFixed = 3;

struct WindowScene {
  Rig rig;
  VoWindow truth;
  VoWindow start;  // free poses and points off
};

WindowScene make_window_scene(int cameras, std::uint64_t seed) {
  Random random(seed, "window");
  WindowScene scene{test::fisheye_rig(cameras), {}, {}};
  scene.truth.fixed = kFixed;
  for (int k = 0; k < kPoses; ++k)
    scene.truth.T_odom_vehicle.push_back(test::on_circle(12.0, 0.25 * k));
  for (int i = 0; i < 120; ++i) {
    const Eigen::Vector3d p(random.uniform(4.0, 20.0), random.uniform(-6.0, 12.0),
                            random.uniform(0.0, 3.0));
    const int point = static_cast<int>(scene.truth.points.size());
    std::vector<WindowView> views;
    for (int k = 0; k < kPoses; ++k)
      for (int c = 0; c < cameras; ++c) {
        const auto& mounted = scene.rig.cameras[static_cast<std::size_t>(c)];
        const auto& T = scene.truth.T_odom_vehicle[static_cast<std::size_t>(k)];
        const Eigen::Vector3d p_camera = (T * mounted.T_vehicle_camera).inverse() * p;
        const auto pixel = mounted.camera.project(p_camera);
        if (p_camera.norm() < 1.0 || !pixel || !mounted.camera.contains(*pixel)) continue;
        views.push_back(
            {k, point, c,
             *pixel + Eigen::Vector2d(random.normal(0.0, 0.4), random.normal(0.0, 0.4))});
      }
    if (views.size() < 3) continue;
    if (i % 20 == 0) views.back().pixel.x() += 25.0;  // a wrong match
    scene.truth.points.push_back(p);
    scene.truth.views.insert(scene.truth.views.end(), views.begin(), views.end());
  }
  scene.start = scene.truth;
  for (int k = kFixed; k < kPoses; ++k) {
    Vector6d xi;
    for (int d = 0; d < 6; ++d) xi(d) = random.normal(0.0, d < 3 ? 0.03 : 0.01);
    auto& T = scene.start.T_odom_vehicle[static_cast<std::size_t>(k)];
    T = T * se3_exp(xi);
  }
  for (auto& p : scene.start.points)
    for (int d = 0; d < 3; ++d) p(d) += random.normal(0.0, 0.1);
  return scene;
}

double pose_error(const VoWindow& a, const VoWindow& b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < a.T_odom_vehicle.size(); ++k)
    largest =
        std::max(largest, se3_log(a.T_odom_vehicle[k].inverse() * b.T_odom_vehicle[k]).norm());
  return largest;
}

// The same cost by Ceres: parameters are perturbations of poses, and points.
struct ViewCost {
  const MountedCamera& mounted;
  const Eigen::Isometry3d& T;
  Eigen::Vector2d pixel;
  double sigma_px;
  bool operator()(const double* const* x, double* residual) const {
    const Eigen::Map<const Vector6d> xi(x[0]);
    const Eigen::Map<const Eigen::Vector3d> p(x[1]);
    const auto seen =
        mounted.camera.project((T * se3_exp(xi) * mounted.T_vehicle_camera).inverse() * p);
    if (!seen) return false;
    residual[0] = (pixel.x() - seen->x()) / sigma_px;
    residual[1] = (pixel.y() - seen->y()) / sigma_px;
    return true;
  }
};

struct MotionCost {
  const Eigen::Isometry3d& A;
  const Eigen::Isometry3d& B;
  bool operator()(const double* const* x, double* residual) const {
    const Eigen::Map<const Vector6d> a(x[0]), b(x[1]);
    const Vector6d xi = se3_log((A * se3_exp(a)).inverse() * (B * se3_exp(b)));
    const Matrix6d information = driving_information(xi.head<3>().norm());
    for (int d = 0; d < 6; ++d) residual[d] = std::sqrt(information(d, d)) * xi(d);
    return true;
  }
};

double cost_by_ceres(const WindowScene& scene, const WindowOptions& options) {
  VoWindow window = scene.start;
  std::vector<Vector6d> xi(window.T_odom_vehicle.size(), Vector6d::Zero());
  ceres::Problem problem;
  for (const WindowView& view : window.views) {
    auto* cost = new ceres::DynamicNumericDiffCostFunction<ViewCost>(
        new ViewCost{scene.rig.cameras[static_cast<std::size_t>(view.camera)],
                     scene.start.T_odom_vehicle[static_cast<std::size_t>(view.pose)], view.pixel,
                     options.sigma_px});
    cost->AddParameterBlock(6);
    cost->AddParameterBlock(3);
    cost->SetNumResiduals(2);
    problem.AddResidualBlock(cost, new ceres::CauchyLoss(options.width_px / options.sigma_px),
                             xi[static_cast<std::size_t>(view.pose)].data(),
                             window.points[static_cast<std::size_t>(view.point)].data());
  }
  for (std::size_t k = kFixed; k < xi.size(); ++k) {
    auto* cost = new ceres::DynamicNumericDiffCostFunction<MotionCost>(
        new MotionCost{scene.start.T_odom_vehicle[k - 1], scene.start.T_odom_vehicle[k]});
    cost->AddParameterBlock(6);
    cost->AddParameterBlock(6);
    cost->SetNumResiduals(6);
    problem.AddResidualBlock(cost, nullptr, xi[k - 1].data(), xi[k].data());
  }
  for (int k = 0; k < kFixed; ++k)
    problem.SetParameterBlockConstant(xi[static_cast<std::size_t>(k)].data());
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_SCHUR;
  solver.max_num_iterations = 200;
  solver.function_tolerance = 1e-12;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  return summary.final_cost;
}

double cost_of(const WindowScene& scene, const VoWindow& window, const WindowOptions& options) {
  double cost = window_cost(scene.rig, window, options);
  for (std::size_t k = kFixed; k < window.T_odom_vehicle.size(); ++k) {
    const Vector6d xi = se3_log(window.T_odom_vehicle[k - 1].inverse() * window.T_odom_vehicle[k]);
    cost += 0.5 * xi.dot(driving_information(xi.head<3>().norm()) * xi);
  }
  return cost;
}

TEST(WindowAdjustment, FindsTheMinimumThatCeresFinds) {
  for (const int cameras : {1, 4}) {
    const WindowScene scene = make_window_scene(cameras, 3);
    WindowOptions options;
    options.iterations = 60;
    VoWindow window = scene.start;
    adjust_window(scene.rig, options, window);
    const double by_ceres = cost_by_ceres(scene, options);
    EXPECT_NEAR(cost_of(scene, window, options) / by_ceres, 1.0, 2e-3) << cameras;
    EXPECT_LT(by_ceres, 0.2 * cost_of(scene, scene.start, options));
  }
}

// With views of little weight the prior of the car's motion decides.
TEST(WindowAdjustment, FindsTheMinimumThatCeresFindsWhereThePriorDecides) {
  const WindowScene scene = make_window_scene(1, 3);
  WindowOptions options;
  options.sigma_px = 20.0;
  options.width_px = 100.0;
  options.iterations = 10;
  VoWindow window = scene.start;
  adjust_window(scene.rig, options, window);
  EXPECT_NEAR(cost_of(scene, window, options) / cost_by_ceres(scene, options), 1.0, 0.02);
}

TEST(WindowAdjustment, TheUsualIterationsTakeMostOfTheErrorAndKeepFixedPoses) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    const WindowScene scene = make_window_scene(1, seed);
    VoWindow window = scene.start;
    adjust_window(scene.rig, {}, window);
    WindowOptions many;
    many.iterations = 60;
    VoWindow best = scene.start;
    adjust_window(scene.rig, many, best);
    EXPECT_LT(cost_of(scene, window, {}), 1.1 * cost_of(scene, best, {}));
    EXPECT_LT(pose_error(window, scene.truth), 0.5 * pose_error(scene.start, scene.truth));
    for (int k = 0; k < kFixed; ++k)
      EXPECT_EQ(window.T_odom_vehicle[static_cast<std::size_t>(k)].matrix(),
                scene.start.T_odom_vehicle[static_cast<std::size_t>(k)].matrix());
  }
}

// In a quarter of the tracks the corner lags behind what it shows, by up to 2 px: too little to be
// taken for wrong, enough to change the car's way.
VoWindow with_lagging_corners(const VoWindow& window) {
  VoWindow lagging = window;
  Eigen::Vector2d first = Eigen::Vector2d::Zero();
  int point = -1;
  for (WindowView& view : lagging.views) {
    if (view.point != point) first = view.pixel;
    point = view.point;
    if (point % 4 != 0) continue;
    const Eigen::Vector2d back = 0.3 * (first - view.pixel);
    view.pixel += back * std::min(1.0, 2.0 / std::max(1e-9, back.norm()));
  }
  return lagging;
}

TEST(WindowAdjustment, CornersThatLagMovePosesLessThanWithAWideCost) {
  double error = 0.0;
  double with_wide_cost = 0.0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const WindowScene scene = make_window_scene(1, seed);
    WindowOptions wide;
    wide.width_px = 2.5;
    VoWindow window = with_lagging_corners(scene.start);
    VoWindow by_wide = window;
    adjust_window(scene.rig, {}, window);
    adjust_window(scene.rig, wide, by_wide);
    error += pose_error(window, scene.truth);
    with_wide_cost += pose_error(by_wide, scene.truth);
  }
  EXPECT_LT(error, 0.85 * with_wide_cost);
}

// Views of one pose are gone, or all but a few: nothing may fling it away.
TEST(WindowAdjustment, LeavesAPoseThatHardlyAnyViewHoldsNearItsStart) {
  for (const int left : {0, 1, 2, 5}) {
    WindowScene scene = make_window_scene(1, 7);
    int kept = 0;
    std::erase_if(scene.start.views,
                  [&](const WindowView& v) { return v.pose == 5 && ++kept > left; });
    VoWindow window = scene.start;
    adjust_window(scene.rig, {}, window);
    const auto k = std::size_t{5};
    EXPECT_LT(se3_log(window.T_odom_vehicle[k].inverse() * scene.truth.T_odom_vehicle[k]).norm(),
              0.2)
        << left;
  }
}

TEST(WindowAdjustment, LeavesWhatHasNothingToAdjust) {
  const WindowScene scene = make_window_scene(1, 5);
  VoWindow all_fixed = scene.start;
  all_fixed.fixed = kPoses;
  adjust_window(scene.rig, {}, all_fixed);
  EXPECT_LT(pose_error(all_fixed, scene.start), 1e-15);
  VoWindow empty = scene.start;
  empty.points.clear();
  empty.views.clear();
  adjust_window(scene.rig, {}, empty);
  EXPECT_LT(pose_error(empty, scene.start), 1e-15);
}

}  // namespace
}  // namespace roadbook
