#include "mapping/localisation/landmark_pose.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "mapping/localisation/spread_ransac.hpp"
#include "tests/mapping/localisation/synthetic_place.hpp"

namespace roadbook {
namespace {

struct Scene {
  Rig rig = half_size(test::fisheye_rig());
  Eigen::Isometry3d T = se3_exp((Vector6d() << 1.0, -2.0, 0.1, 0.02, -0.03, 0.8).finished());
  std::vector<LandmarkPixel> pixels;
};

Scene scene(std::uint64_t seed, double sigma_px, double sigma_m) {
  Scene s;
  Random random(seed, "landmark pose");
  while (s.pixels.size() < 120) {
    const Eigen::Vector3d p =
        s.T * Eigen::Vector3d(random.uniform(-9.0, 9.0), random.uniform(-9.0, 9.0),
                              random.uniform(0.0, 3.0));
    const auto camera = static_cast<std::size_t>(random.below(4));
    const auto pixel = test::seen_at(s.rig, camera, s.T, p, 30.0);
    if (!pixel) continue;
    const Eigen::Vector2d noise(random.normal(), random.normal());
    const Eigen::Vector3d off(random.normal(), random.normal(), random.normal());
    s.pixels.push_back({static_cast<int>(camera), *pixel + sigma_px * noise, p + sigma_m * off,
                        sigma_m * sigma_m * Eigen::Matrix3d::Identity()});
  }
  return s;
}

// The Gauss-Newton of visual odometry is an independent second method: same errors, same loss.
TEST(LandmarkPose, AgreesWithGaussNewton) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Scene s = scene(seed, 0.6, 0.0);
    std::vector<RigObservation> observations;
    for (const auto& p : s.pixels) observations.push_back({p.camera, p.pixel, p.p_map});
    RigPoseOptions gauss;
    gauss.sigma_px = 0.6;
    gauss.inlier_px = 2.4;
    gauss.iterations = 60;
    LandmarkPoseOptions options;
    options.sigma_px = 0.6;
    options.loss_sigma = 0.5 * gauss.inlier_px / gauss.sigma_px;
    options.relative_tolerance = 1e-14;
    options.max_iterations = 50;
    const Eigen::Isometry3d initial =
        s.T * se3_exp((Vector6d() << 0.05, -0.03, 0.02, 0.01, -0.01, 0.02).finished());
    const auto a = refine_rig_pose(s.rig, observations, initial, std::nullopt, gauss);
    const auto b = solve_landmark_pose(s.rig, s.pixels, initial, std::nullopt, options);
    ASSERT_TRUE(a && b);
    EXPECT_LT(se3_log(a->T_world_vehicle.inverse() * b->T_map_vehicle).norm(), 1e-6);
    // The information as well, less the part that the loss costs.
    const CauchyMoments m = cauchy_moments(options.loss_sigma);
    const Matrix6d expected = m.hessian * m.hessian / m.squared_pull * a->information;
    EXPECT_LT((expected - b->information).norm(), 1e-3 * expected.norm());
  }
}

// A prior as strong as the pixels: the derivative of the whole cost is zero at the solution.
TEST(LandmarkPose, PriorPullsAsItsInformationSays) {
  const Scene s = scene(3, 0.0, 0.0);
  const auto free = solve_landmark_pose(s.rig, s.pixels, s.T, std::nullopt);
  ASSERT_TRUE(free);
  EXPECT_LT(se3_log(s.T.inverse() * free->T_map_vehicle).norm(), 1e-9);
  const Vector6d off = (Vector6d() << 0.001, 0.002, -0.001, 0.0005, -0.0005, 0.001).finished();
  // Without errors the loss costs nothing.
  const CauchyMoments m = cauchy_moments(LandmarkPoseOptions{}.loss_sigma);
  const Matrix6d information = m.squared_pull / (m.hessian * m.hessian) * free->information;
  const RigPosePrior prior{s.T * se3_exp(off), 3.0 * information};
  const auto pulled = solve_landmark_pose(s.rig, s.pixels, s.T, prior);
  ASSERT_TRUE(pulled);
  // Information 3 against 1: three quarters of the way.
  EXPECT_LT((se3_log(s.T.inverse() * pulled->T_map_vehicle) - 0.75 * off).norm(),
            0.02 * off.norm());
}

// With the stated noise, the normalised error of the pose and the pull of groups are as expected.
TEST(LandmarkPose, CovarianceHoldsForPixelsAndLandmarks) {
  const LandmarkPoseOptions options;
  double nees = 0.0;
  double found = 0.0;
  double expected = 0.0;
  constexpr int kScenes = 150;
  for (int i = 0; i < kScenes; ++i) {
    const Scene s = scene(static_cast<std::uint64_t>(50 + i), 0.6, 0.03);
    const auto pose = solve_landmark_pose(s.rig, s.pixels, s.T, std::nullopt, options);
    ASSERT_TRUE(pose);
    const Vector6d xi = se3_log(pose->T_map_vehicle.inverse() * s.T);
    nees += xi.dot(pose->information * xi) / 6.0;
    found += pose->pull_found;
    expected += pose->pull_expected;
  }
  EXPECT_NEAR(nees / kScenes, 1.0, 3.0 * std::sqrt(1.0 / 3.0 / kScenes));
  EXPECT_NEAR(found / expected, 1.0, 0.1);
}

// Errors that neighbouring landmarks share pull together: the factor grows with them.
TEST(LandmarkPose, CommonErrorsPullMore) {
  Scene s = scene(9, 0.6, 0.0);
  const auto alone = solve_landmark_pose(s.rig, s.pixels, s.T, std::nullopt);
  for (LandmarkPixel& p : s.pixels) {
    // To the one side in one eighth of the horizon, to the other in the next: no pose explains
    // that.
    const Eigen::Vector3d v = s.T.inverse() * p.p_map;
    const int eighth =
        static_cast<int>(std::floor(std::atan2(v.y(), v.x()) * 4.0 / std::numbers::pi));
    p.pixel.x() += eighth % 2 == 0 ? 0.8 : -0.8;
  }
  const auto common = solve_landmark_pose(s.rig, s.pixels, s.T, std::nullopt);
  ASSERT_TRUE(alone && common);
  EXPECT_GT(common->pull_found / common->pull_expected,
            2.0 * alone->pull_found / alone->pull_expected);
}

// Half of the pairs are wrong, and nearly all pairs are of one camera.
TEST(SpreadRansac, UsesAllCamerasAndRepeatsItself) {
  const Scene s = scene(4, 0.5, 0.0);
  Random random(1, "wrong pairs");
  std::vector<RigObservation> pairs;
  int of_others = 0;
  for (const auto& p : s.pixels) {
    if (p.camera != 0 && ++of_others > 12) continue;
    pairs.push_back({p.camera, p.pixel, p.p_map});
    pairs.push_back({p.camera, {random.uniform(0.0, 319.0), random.uniform(0.0, 239.0)}, p.p_map});
  }
  const auto T = find_spread_rig_pose(s.rig, pairs);
  ASSERT_TRUE(T);
  EXPECT_LT(se3_log(s.T.inverse() * *T).norm(), 0.15);
  const auto again = find_spread_rig_pose(s.rig, pairs);
  EXPECT_EQ(T->matrix(), again->matrix());
  // One camera alone: Kneip's solver, with the camera's place on the vehicle.
  std::erase_if(pairs, [](const RigObservation& p) { return p.camera != 0; });
  const auto single = find_spread_rig_pose(s.rig, pairs);
  ASSERT_TRUE(single);
  EXPECT_LT(se3_log(s.T.inverse() * *single).norm(), 0.3);
  EXPECT_FALSE(find_spread_rig_pose(s.rig, std::span(pairs).first(3)));
}

}  // namespace
}  // namespace roadbook
