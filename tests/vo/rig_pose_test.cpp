#include "vo/rig_pose.hpp"

#include <gtest/gtest.h>

#include "tests/vo/synthetic_views.hpp"

namespace roadbook {
namespace {

using test::fisheye_rig;

struct Scene {
  Rig rig;
  Eigen::Isometry3d truth;
  std::vector<RigObservation> seen;
  std::vector<bool> wrong;
};

Scene scene(int cameras, double sigma_px, double outliers, std::uint64_t seed) {
  Random random(seed, "scene");
  Scene s{fisheye_rig(cameras), test::on_circle(12.0, random.uniform(0.0, 60.0)), {}, {}};
  const auto corners = test::corners_around(25.0, 800, random);
  const auto view = test::view_from(s.truth, s.rig, corners, 20.0, sigma_px, random);
  for (std::size_t c = 0; c < view.features.size(); ++c)
    for (std::size_t f = 0; f < view.features[c].size(); ++f) {
      const bool wrong = random.uniform() < outliers;
      const auto corner =
          wrong ? random.below(corners.size()) : static_cast<std::size_t>(view.corner[c][f]);
      s.seen.push_back({static_cast<int>(c), view.features[c].pixels[f].cast<double>(),
                        corners[corner].p_world});
      s.wrong.push_back(wrong);
    }
  return s;
}

// Normalised error squared is chi-square with 6 degrees of freedom: mean 6. The robust weights take
// away a little of the information, so that the estimate is no better than it says.
TEST(RigPose, ErrorsAreAsLargeAsTheCovarianceSays) {
  double sum = 0.0;
  constexpr int kRuns = 100;
  for (int run = 0; run < kRuns; ++run) {
    const Scene s = scene(4, 0.5, 0.0, static_cast<std::uint64_t>(run));
    RigPoseOptions options;
    options.sigma_px = 0.5;
    options.inlier_px = 100.0;  // no robust weights: Gauss-Newton proper
    const auto pose = refine_rig_pose(s.rig, s.seen, s.truth, std::nullopt, options);
    ASSERT_TRUE(pose);
    const Vector6d xi = se3_log(s.truth.inverse() * pose->T_world_vehicle);
    sum += xi.dot(pose->information * xi);
  }
  // 99.9 % band of the mean of 100 draws: 6 +- 3.3 * sqrt(12 / 100).
  EXPECT_NEAR(sum / kRuns, 6.0, 1.15);
}

TEST(RigPose, IsFoundWithoutAGuessAmongWrongMatches) {
  for (const int cameras : {1, 2, 4})
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      SCOPED_TRACE(::testing::Message() << cameras << " cameras, seed " << seed);
      const Scene s = scene(cameras, 0.5, 0.4, seed);
      const auto pose = find_rig_pose(s.rig, s.seen, {});
      ASSERT_TRUE(pose);
      const Vector6d xi = se3_log(s.truth.inverse() * pose->T_world_vehicle);
      EXPECT_LT(xi.head<3>().norm(), 0.05);
      EXPECT_LT(xi.tail<3>().norm(), 0.005);
      std::size_t mistaken = 0;
      for (std::size_t i = 0; i < s.seen.size(); ++i)
        mistaken += static_cast<std::size_t>(s.wrong[i] == (pose->inlier[i] != 0));
      EXPECT_LT(mistaken, s.seen.size() / 20);
    }
}

TEST(RigPose, OfNothingButWrongMatchesHasHardlyAnInlier) {
  const Scene s = scene(4, 0.5, 1.0, 1);
  const auto pose = find_rig_pose(s.rig, s.seen, {});
  EXPECT_LT(pose ? pose->inliers : 0, static_cast<int>(s.seen.size()) / 10);
}

TEST(RigPose, OfTooFewPointsIsEmpty) {
  const Scene s = scene(4, 0.5, 0.0, 1);
  EXPECT_FALSE(find_rig_pose(s.rig, std::span(s.seen).first(5), {}));
}

}  // namespace
}  // namespace roadbook
