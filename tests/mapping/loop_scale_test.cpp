#include "mapping/loops/loop_scale.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"
#include "sensors/camera_centre.hpp"

namespace roadbook {
namespace {

// Two keyframes of one camera, 0.5 m apart. The odometry has `unit_from` metres a unit at the first
// and `unit_to` at the second, so that places and the measured motion are in other units.
struct TwoPasses {
  Rig rig;
  VoResult odometry;
  LoopEdge edge;
  std::vector<FeatureMatch> matches;
};

TwoPasses two_passes(double unit_from, double unit_to, int corners, int wrong, std::uint64_t seed) {
  Random random(seed, "passes");
  TwoPasses passes;
  MountedCamera camera;
  camera.T_vehicle_camera.translation() = Eigen::Vector3d(1.5, 0.0, 1.2) / unit_from;
  passes.rig.cameras.push_back(camera);
  const Eigen::Isometry3d T_world_to(Eigen::Translation3d(0.5, 0.1, 0.0));
  passes.odometry.keyframes.resize(2);
  for (VoKeyframe& k : passes.odometry.keyframes)
    k.tracks.assign(1, std::vector<int>(static_cast<std::size_t>(corners), -1));
  for (int i = 0; i < corners; ++i) {
    const Eigen::Vector3d p_world(random.uniform(4.0, 12.0), random.uniform(-4.0, 4.0),
                                  random.uniform(0.0, 3.0));
    const bool is_wrong = i < wrong;
    for (int k = 0; k < 2; ++k) {
      Track track;
      track.p_odom = k == 0 ? Eigen::Vector3d(p_world / unit_from)
                            : Eigen::Vector3d(T_world_to.inverse() * p_world / unit_to);
      if (is_wrong && k == 1) *track.p_odom *= random.uniform(2.0, 5.0);
      passes.odometry.keyframes[static_cast<std::size_t>(k)]
          .tracks[0][static_cast<std::size_t>(i)] = static_cast<int>(passes.odometry.tracks.size());
      passes.odometry.tracks.push_back(track);
    }
    passes.matches.push_back({0, i, 0, i});
  }
  passes.edge.from = 0;
  passes.edge.to = 1;
  passes.edge.T_from_to = Eigen::Isometry3d(
      Eigen::Translation3d(Eigen::Vector3d(T_world_to.translation() / unit_from)));
  return passes;
}

// Distances are taken from the camera; at the origin of the vehicle the ratio is exact.
TEST(LoopScale, IsTheRatioOfTheUnitsOfBothPassesWithAQuarterOfWrongCorners) {
  for (const double drift : {-0.5, -0.1, 0.2, 0.6}) {
    TwoPasses passes = two_passes(1.0, std::exp(drift), 60, 15, 3);
    passes.rig.cameras[0].T_vehicle_camera.setIdentity();
    const auto scale = scale_of_loop(passes.rig, passes.odometry, passes.edge, passes.matches);
    ASSERT_TRUE(scale);
    EXPECT_NEAR(scale->log_scale, drift, 2.0 * scale->sigma);
    EXPECT_LT(scale->sigma, 0.1);
  }
}

TEST(LoopScale, OfFewCornersIsNotMeasured) {
  TwoPasses passes = two_passes(1.0, 1.3, 5, 0, 4);
  EXPECT_FALSE(scale_of_loop(passes.rig, passes.odometry, passes.edge, passes.matches));
  passes = two_passes(1.0, 1.3, 6, 0, 4);
  EXPECT_TRUE(scale_of_loop(passes.rig, passes.odometry, passes.edge, passes.matches));
  for (Track& track : passes.odometry.tracks) track.p_odom.reset();
  EXPECT_FALSE(scale_of_loop(passes.rig, passes.odometry, passes.edge, passes.matches));
}

TEST(LoopScale, TheCentreOfTheCamerasIsTheirMean) {
  Rig rig;
  for (const double x : {1.0, -3.0}) {
    MountedCamera camera;
    camera.T_vehicle_camera.translation() = Eigen::Vector3d(x, 2.0, 0.5);
    rig.cameras.push_back(camera);
  }
  EXPECT_EQ(centre_of_cameras(rig), Eigen::Vector3d(-1.0, 2.0, 0.5));
}

}  // namespace
}  // namespace roadbook
