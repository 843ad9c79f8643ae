#include "mapping/optimisation/cluster_covariance.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <map>

#include "mapping/known_covariance.hpp"
#include "tests/mapping/synthetic_bundle.hpp"

namespace roadbook {
namespace {

std::vector<int> one_piece(const BundleProblem& problem) {
  return std::vector<int>(problem.poses.size(), 0);
}

// Adds an error to the pixels of each landmark in each camera that changes slowly from pose to
// pose: a first-order autoregressive process of standard deviation `sigma_px`.
void add_slow_errors(double sigma_px, std::uint64_t seed, BundleProblem& problem) {
  constexpr double kKept = 0.95;
  Random random(seed, "slow errors");
  std::map<std::pair<int, int>, Eigen::Vector2d> last;
  for (BundleObservation& o : problem.observations) {  // ascending in the pose
    const Eigen::Vector2d fresh(sigma_px * random.normal(), sigma_px * random.normal());
    const auto [found, is_new] = last.try_emplace({o.point, o.camera}, fresh);
    if (!is_new) found->second = kKept * found->second + std::sqrt(1.0 - kKept * kKept) * fresh;
    o.pixel += found->second;
  }
}

// Errors that the views of a landmark share: independent noise explains far too little of the
// poses' errors, clusters explain them. Judged by the truth of the simulation.
TEST(ClusterCovariance, CoversErrorsThatTheViewsOfALandmarkShare) {
  constexpr int kRuns = 12;
  double plain = 0.0;
  double clustered = 0.0;
  int inside = 0;
  int count = 0;
  for (int run = 0; run < kRuns; ++run) {
    const auto seed = 300 + static_cast<std::uint64_t>(run);
    test::SyntheticBundle s = test::synthetic_bundle(
        {.length_m = 30.0, .spacing_m = 0.5, .point_count = 120, .sigma_px = 0.2}, seed);
    add_slow_errors(1.0, seed, s.problem);
    const BundleOptions options = test::exact_options();
    const BundleResult result = bundle_adjust(s.problem, options);
    ASSERT_TRUE(result.usable);
    const auto by_pixels = bundle_covariance(s.problem, result.inlier, options);
    const auto by_clusters =
        cluster_covariance(s.problem, result.inlier, one_piece(s.problem), options);
    ASSERT_TRUE(by_clusters.usable) << by_clusters.message;
    for (const BundlePose& pose : s.problem.poses) EXPECT_FALSE(pose.fixed);
    EXPECT_EQ(by_clusters.poses[0], Matrix6d::Zero());
    for (const std::size_t i : {s.poses.size() / 4, s.poses.size() / 2}) {
      const Vector6d e = se3_log(s.problem.poses[i].T_map_vehicle.inverse() * s.poses[i]);
      plain += e.dot(by_pixels.poses[i].ldlt().solve(e)) / 6.0;
      const double chi2 = e.dot(by_clusters.poses[i].ldlt().solve(e));
      clustered += chi2 / 6.0;
      inside += chi2 < 12.592 ? 1 : 0;
      ++count;
    }
  }
  std::printf("squared errors over variances: independent %.2f, clusters %.2f, %d of %d inside\n",
              plain / count, clustered / count, inside, count);
  EXPECT_GT(plain / count, 3.0);
  EXPECT_LT(clustered / count, 1.3);
  EXPECT_GT(clustered / count, 0.2);
  EXPECT_GE(inside, 22);  // of 24: 90 %
}

// The same drive twice in one problem, with nothing between: each part has its own gauge, and its
// covariances are those that it has alone, up to the draws of the signs.
TEST(ClusterCovariance, EachPieceIsRelativeToItsOwnFirstPose) {
  test::SyntheticBundle s = test::synthetic_bundle({.length_m = 20.0, .point_count = 60}, 7);
  const BundleOptions options = test::exact_options();
  ASSERT_TRUE(bundle_adjust(s.problem, options).usable);
  const auto alone = cluster_covariance(s.problem, {}, one_piece(s.problem), options);
  BundleProblem both = s.problem;
  const int poses = static_cast<int>(s.problem.poses.size());
  const int points = static_cast<int>(s.problem.points.size());
  both.poses.insert(both.poses.end(), s.problem.poses.begin(), s.problem.poses.end());
  for (BundlePoint point : s.problem.points) {
    if (point.ground_pose >= 0) point.ground_pose += poses;
    both.points.push_back(point);
  }
  for (BundleObservation o : s.problem.observations) {
    o.pose += poses;
    o.point += points;
    both.observations.push_back(o);
  }
  for (MotionConstraint m : s.problem.motions) {
    m.from += poses;
    m.to += poses;
    both.motions.push_back(m);
  }
  std::vector<int> piece(both.poses.size(), 0);
  std::fill(piece.begin() + poses, piece.end(), 1);
  const auto apart = cluster_covariance(both, {}, piece, options);
  ASSERT_TRUE(alone.usable && apart.usable);
  const auto first = static_cast<std::size_t>(poses);
  EXPECT_EQ(apart.poses[0], Matrix6d::Zero());
  EXPECT_EQ(apart.poses[first], Matrix6d::Zero());
  for (std::size_t i = 1; i < first; ++i)
    for (int k = 0; k < 6; ++k)
      EXPECT_NEAR(std::sqrt(apart.poses[first + i](k, k) / alone.poses[i](k, k)), 1.0, 0.35)
          << "pose " << i << " component " << k;
  // As one piece, nothing ties the second part: unknown, and the first stays known.
  const auto loose = cluster_covariance(both, {}, one_piece(both), options);
  ASSERT_TRUE(loose.usable);
  EXPECT_TRUE(is_known(loose.poses[first - 1]));
  for (std::size_t i = first; i < both.poses.size(); ++i) EXPECT_FALSE(is_known(loose.poses[i]));
}

TEST(ClusterCovariance, IsTheSameOnAnyNumberOfThreads) {
  test::SyntheticBundle s = test::synthetic_bundle({.length_m = 20.0, .point_count = 60}, 8);
  BundleOptions options = test::exact_options();
  ASSERT_TRUE(bundle_adjust(s.problem, options).usable);
  const auto one = cluster_covariance(s.problem, {}, one_piece(s.problem), options);
  options.num_threads = 3;
  const auto three = cluster_covariance(s.problem, {}, one_piece(s.problem), options);
  for (std::size_t i = 0; i < one.poses.size(); ++i) EXPECT_EQ(one.poses[i], three.poses[i]);
}

// Wheels that contradict the cameras: the map is off, and its covariances grow.
TEST(ClusterCovariance, WheelsThatStoodStillWidenIt) {
  test::SyntheticBundle s = test::synthetic_bundle(
      {.length_m = 30.0, .spacing_m = 0.5, .point_count = 60, .ground_share = 0.0}, 9);
  BundleProblem stuck = s.problem;
  for (std::size_t i = 20; i < 30; ++i) stuck.motions[i].T_from_to.setIdentity();
  const BundleOptions options = test::exact_options();
  ASSERT_TRUE(bundle_adjust(s.problem, options).usable);
  ASSERT_TRUE(bundle_adjust(stuck, options).usable);
  const auto good = cluster_covariance(s.problem, {}, one_piece(s.problem), options);
  const auto bad = cluster_covariance(stuck, {}, one_piece(stuck), options);
  const auto variance = [](const ClusterCovariance& of) {
    return of.poses[30](0, 0) + of.poses[30](1, 1);
  };
  std::printf("standard deviation %.4f m, stuck %.4f m\n", std::sqrt(variance(good)),
              std::sqrt(variance(bad)));
  EXPECT_GT(variance(bad), 4.0 * variance(good));
}

}  // namespace
}  // namespace roadbook
