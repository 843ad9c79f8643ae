#include "vo/two_view.hpp"

#include <gtest/gtest.h>

#include "tests/vo/synthetic_views.hpp"

namespace roadbook {
namespace {

// Pairs of directions from two views of the same corners, some of them wrong.
std::vector<BearingPair> pairs_of(const Rig& rig,
                                  const Eigen::Isometry3d& T_old_new,
                                  double wrong,
                                  std::uint64_t seed) {
  Random random(seed, "pairs");
  const auto corners = test::corners_around(15.0, 600, random);
  const auto a = test::view_from(Eigen::Isometry3d::Identity(), rig, corners, 15.0, 0.3, random);
  const auto b = test::view_from(T_old_new, rig, corners, 15.0, 0.3, random);
  std::vector<BearingPair> pairs;
  for (std::size_t c = 0; c < rig.cameras.size(); ++c)
    for (std::size_t i = 0; i < a.corner[c].size(); ++i)
      for (std::size_t j = 0; j < b.corner[c].size(); ++j) {
        if (a.corner[c][i] != b.corner[c][j]) continue;
        const auto k = random.uniform() < wrong ? random.below(b.corner[c].size()) : j;
        const auto& camera = rig.cameras[c].camera;
        const auto from = camera.bearing(a.features[c].pixels[i].cast<double>());
        const auto to = camera.bearing(b.features[c].pixels[k].cast<double>());
        if (from && to) pairs.push_back({static_cast<int>(c), *from, *to});
      }
  return pairs;
}

std::vector<Eigen::Isometry3d> mounts_of(const Rig& rig) {
  std::vector<Eigen::Isometry3d> mounts;
  for (const auto& mounted : rig.cameras) mounts.push_back(mounted.T_vehicle_camera);
  return mounts;
}

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0));
}

TEST(TwoView, FindsDirectionAndTurnOfOneCamera) {
  const Rig rig = test::fisheye_rig(1);
  const Eigen::Isometry3d T_vehicle = pose_from_planar(1.0, 0.1, 0.15);
  const Eigen::Isometry3d& mount = rig.cameras[0].T_vehicle_camera;
  const Eigen::Isometry3d T_camera = mount.inverse() * T_vehicle * mount;
  const auto pairs = pairs_of(rig, T_vehicle, 0.2, 1);
  const auto found = find_two_view(pairs, 0.01);
  ASSERT_TRUE(found);
  EXPECT_LT(angle_between(found->T_old_new.translation(), T_camera.translation()), 0.03);
  EXPECT_LT(so3_log(found->T_old_new.linear().transpose() * T_camera.linear()).norm(), 0.01);
  EXPECT_GT(found->inliers.size(), pairs.size() * 7 / 10);
}

TEST(ArcMotion, IsFoundForwardsAndBackwards) {
  const Rig rig = test::fisheye_rig();
  for (const double distance : {0.6, -0.6})
    for (const double turn : {-0.2, 0.0, 0.1}) {
      SCOPED_TRACE(::testing::Message() << distance << " m, " << turn << " rad");
      // Along an arc the chord points half-way between the two headings.
      const Eigen::Isometry3d truth =
          pose_from_planar(distance * std::cos(0.5 * turn), distance * std::sin(0.5 * turn), turn);
      const auto found = find_arc_motion(pairs_of(rig, truth, 0.2, 2), mounts_of(rig), 0.6, 0.01);
      ASSERT_TRUE(found);
      const Vector6d xi = se3_log(truth.inverse() * found->T_old_new);
      EXPECT_LT(xi.head<3>().norm(), 0.05);
      EXPECT_LT(xi.tail<3>().norm(), 0.01);
    }
}

// Wheels that are wrong by 2 mrad and 5 mm across.
TEST(TwoView, EpipolarPlanesCorrectTheTurnOfTheWheels) {
  const Rig rig = test::fisheye_rig();
  const Eigen::Isometry3d truth = pose_from_planar(0.3, 0.01, 0.03);
  const Eigen::Isometry3d wheels = pose_from_planar(0.305, 0.015, 0.032);
  Vector6d sigma;
  sigma << 0.01, 0.01, 0.01, 0.01, 0.01, 0.01;
  const Matrix6d information = sigma.cwiseAbs2().cwiseInverse().asDiagonal();
  const auto found =
      refine_motion(pairs_of(rig, truth, 0.1, 4), mounts_of(rig), wheels, information, 0.002);
  ASSERT_TRUE(found);
  const Vector6d xi = se3_log(truth.inverse() * *found);
  EXPECT_LT(xi.tail<3>().norm(), 0.0007);
  EXPECT_LT(std::abs(xi(1)), 0.002);
}

TEST(TwoView, OfTooFewPairsIsEmpty) {
  const auto pairs = pairs_of(test::fisheye_rig(1), pose_from_planar(1.0, 0.0, 0.0), 0.0, 3);
  EXPECT_FALSE(find_two_view({pairs.begin(), pairs.begin() + 4}, 0.01));
}

}  // namespace
}  // namespace roadbook
