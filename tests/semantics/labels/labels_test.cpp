#include "semantics/labels/labels.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "base/error.hpp"
#include "base/random.hpp"
#include "tests/semantics/label_map.hpp"

namespace roadbook {
namespace {

OrientedBox some_box(Random& random) {
  return {{random.uniform(-4.0, 14.0), random.uniform(2.0, 7.0)},
          random.uniform(-3.0, 3.0),
          random.uniform(4.0, 6.0),
          random.uniform(2.0, 3.0)};
}

TEST(Labels, ABoxComesBackFromItsAnchorAlsoOnTiltedGround) {
  const Map map = test::label_map(12);
  Random random(1, "boxes");
  for (int i = 0; i < 50; ++i) {
    const OrientedBox box = some_box(random);
    const LabelAnchor anchor{0, map.keyframes[random.below(12)].t_ns, 0};
    const auto back = box_in_map(map, label_of_box(map, anchor, box));
    ASSERT_TRUE(back);
    EXPECT_NEAR((back->centre - box.centre).norm(), 0.0, 1e-9);
    EXPECT_NEAR(std::remainder(back->heading - box.heading, 2.0 * std::numbers::pi), 0.0, 1e-9);
  }
}

TEST(Labels, MoveWithTheirVehiclePoseAndWithNoOther) {
  Map map = test::label_map(12);
  const OrientedBox box{{4.0, 5.0}, 0.3, 5.0, 2.5};
  const Label label = label_of_box(map, {0, map.keyframes[5].t_ns, 0}, box);
  const Eigen::Isometry3d before = map.T_map_vehicle(5);
  const Eigen::Isometry3d moved = pose_from_planar(0.4, -0.2, 0.1) * before;
  const auto frame = static_cast<std::size_t>(map.keyframes[5].map_frame);
  map.keyframes[5].T_frame_vehicle = map.map_frames[frame].T_map_frame.inverse() * moved;
  map.keyframes[6].T_frame_vehicle.translation().x() += 10.0;
  const auto now = box_in_map(map, label);
  const Eigen::Vector3d want =
      moved * before.inverse() * Eigen::Vector3d(box.centre.x(), box.centre.y(), 0.0);
  // The box lies in the vehicle's plane, which tilts by a degree. Its height is therefore not that
  // of z = 0.
  EXPECT_NEAR((now->centre - want.head<2>()).norm(), 0.0, 0.02);
  EXPECT_NEAR(now->heading, 0.4, 1e-3);
}

TEST(Labels, TheirEllipseHoldsTheirTruthAsOftenAsItSays) {
  const Map map = test::label_map(40);
  Random random(3, "truth");
  int inside = 0;
  constexpr int kLabels = 1000;
  for (int i = 0; i < kLabels; ++i) {
    const std::size_t k = random.below(40);
    const Keyframe& keyframe = map.keyframes[k];
    const OrientedBox box = some_box(random);
    Label label = label_of_box(map, {0, keyframe.t_ns, 0}, box);
    label.sigma_m = 0.05;
    // The true pose differs from the pose in the map, and the drawn box differs from its true
    // place.
    Vector6d xi;
    for (int j = 0; j < 6; ++j) xi[j] = random.normal();
    xi = keyframe.covariance.llt().matrixL() * xi;
    const Eigen::Isometry3d T_true = map.T_map_vehicle(static_cast<int>(k)) * se3_exp(xi);
    const Eigen::Vector2d truth = (T_true * label.T_vehicle_label.translation()).head<2>() +
                                  label.sigma_m * Eigen::Vector2d(random.normal(), random.normal());
    const Eigen::Vector2d d = truth - box_in_map(map, label)->centre;
    inside += d.dot(covariance_in_map(map, label)->ldlt().solve(d)) < 5.991 ? 1 : 0;
  }
  EXPECT_GE(inside, 930);
  EXPECT_LE(inside, 970);
}

// Beside an unknown pose, and between it and a known one.
TEST(Labels, AnUnknownCovarianceOfThePoseIsRefused) {
  Map map = test::label_map(40);
  const Label label = label_of_box(map, {0, map.keyframes[7].t_ns, 0}, {{3.0, 4.0}, 0.3, 5.0, 2.5});
  ASSERT_TRUE(covariance_in_map(map, label));
  map.keyframes[7].covariance = unknown_covariance<Matrix6d>();
  EXPECT_FALSE(covariance_in_map(map, label));
  EXPECT_FALSE(sigma_in_map(map, label));
  EXPECT_TRUE(box_in_map(map, label));
  ASSERT_TRUE(seen_in_map(map, label));
  EXPECT_FALSE(is_known(seen_in_map(map, label)->covariance));
  const std::int64_t between = (map.keyframes[6].t_ns + map.keyframes[7].t_ns) / 2;
  ASSERT_TRUE(track_pose(map, 0, between));
  EXPECT_FALSE(is_known(track_pose(map, 0, between)->covariance));
}

TEST(Labels, HangOnTheImageInWhichTheyAreMostCentral) {
  const Map map = test::label_map(30);
  const OrientedBox box{{3.0, 4.0}, 0.5 * std::numbers::pi, 5.0, 2.5};
  const auto corners = box.corners();
  const auto anchor = most_central_view(map, {corners.begin(), corners.end()});
  ASSERT_TRUE(anchor);
  // By hand: the smallest angle between the middle and an axis over all images that see all
  // corners.
  double least = 1e9;
  LabelAnchor want;
  for (std::size_t k = 0; k < map.keyframes.size(); ++k)
    for (std::size_t c = 0; c < map.sessions[0].rig.cameras.size(); ++c) {
      const MountedCamera& mounted = map.sessions[0].rig.cameras[c];
      const Eigen::Isometry3d T_camera_map =
          (map.T_map_vehicle(static_cast<int>(k)) * mounted.T_vehicle_camera).inverse();
      const Label label = label_of_box(map, {0, map.keyframes[k].t_ns, 0}, box);
      bool seen = true;
      for (const auto& p : corners_in_map(map, label)) {
        const auto pixel = mounted.camera.project(T_camera_map * p);
        seen = seen && pixel && pixel->x() >= 0.0 && pixel->x() <= mounted.camera.width - 1 &&
               pixel->y() >= 0.0 && pixel->y() <= mounted.camera.height - 1;
      }
      const Eigen::Vector3d middle = T_camera_map * map.T_map_vehicle(static_cast<int>(k)) *
                                     label.T_vehicle_label.translation();
      const double angle = std::acos(middle.normalized().z());
      if (!seen || middle.norm() > 12.0 || angle >= least) continue;
      least = angle;
      want = {0, map.keyframes[k].t_ns, static_cast<int>(c)};
    }
  EXPECT_EQ(anchor->t_ns, want.t_ns);
  EXPECT_EQ(anchor->camera, want.camera);
  EXPECT_FALSE(most_central_view(map, {Eigen::Vector2d(500.0, 500.0)}));
}

TEST(Labels, AnIndexOfTheKeyframesGivesTheSameAnchors) {
  const Map map = test::label_map(60);
  const KeyframeIndex keyframes(map);
  for (double x = -40.0; x < 80.0; x += 1.7)
    for (const double y : {-30.0, -5.0, 3.0, 4.0, 14.0}) {
      const auto box = OrientedBox{{x, y}, 1.5, 5.0, 2.5}.corners();
      const std::vector<Eigen::Vector2d> corners(box.begin(), box.end());
      EXPECT_EQ(anchor_for(keyframes, corners), anchor_for(map, corners)) << x << " " << y;
    }
}

TEST(Labels, AnAnchorThatTheMapLacksHasNoPlace) {
  const Map map = test::label_map(5);
  EXPECT_FALSE(keyframe_of(map, {0, 12345, 0}));
  EXPECT_FALSE(keyframe_of(map, {7, map.keyframes[1].t_ns, 0}));
  EXPECT_THROW((void)label_of_box(map, {0, 12345, 0}, {}), InvalidOption);
  Label label;
  label.anchor.t_ns = 12345;
  EXPECT_FALSE(box_in_map(map, label));
  EXPECT_FALSE(covariance_in_map(map, label));
  EXPECT_TRUE(corners_in_map(map, label).empty());
}

}  // namespace
}  // namespace roadbook
