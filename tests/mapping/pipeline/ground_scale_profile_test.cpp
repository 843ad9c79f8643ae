#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"
#include "mapping/pipeline/checkpoint_blobs.hpp"
#include "mapping/pipeline/ground.hpp"
#include "tests/support/fisheye_rig.hpp"

namespace roadbook {
namespace {

// A road of 40 m, driven twice by cameras alone. A unit of the odometry has `metres_a_unit`, and
// the second pass lies `rise_m` higher, as before loops are closed.
struct TwoPasses {
  MappingInput input;
  std::vector<Eigen::Isometry3d> poses;
  std::vector<JoinedTrack> tracks;
};

TwoPasses drive_twice(double metres_a_unit, double rise_m) {
  constexpr int kPassSteps = 200;
  constexpr double kStepM = 0.2;
  Random random(4, "road");
  TwoPasses road;
  road.input.half_rigs = {test::fisheye_rig()};
  road.input.has_wheels = {false};
  const double camera_m = road.input.half_rigs[0].cameras[0].T_vehicle_camera.translation().z();
  for (int k = 0; k < 2 * kPassSteps; ++k) {
    const bool again = k >= kPassSteps;
    VoKeyframe keyframe;
    keyframe.T_odom_vehicle = pose_from_planar((k % kPassSteps) * kStepM / metres_a_unit, 0.0, 0.0);
    // The car's origin lies where the cameras' height over it is as calibrated.
    keyframe.T_odom_vehicle.translation().z() =
        camera_m / metres_a_unit - camera_m + (again ? rise_m : 0.0);
    road.poses.push_back(keyframe.T_odom_vehicle);
    road.input.session.push_back(0);
    road.input.odometry.keyframes.push_back(keyframe);
    // More corners in the first pass than in the second.
    for (int i = 0; i < (again ? 4 : 12); ++i) {
      JoinedTrack track;
      track.views = {{k, 0, 0}, {k, 1, 0}};
      const double x = road.poses.back().translation().x() + random.uniform(-0.5, 0.5);
      track.p_map = Eigen::Vector3d(x, random.uniform(-1.2, 1.2),
                                    (again ? rise_m : 0.0) + random.normal(0.0, 0.005));
      road.tracks.push_back(track);
    }
  }
  return road;
}

TEST(GroundScaleProfile, GivesTheMetresAUnit) {
  for (const double metres_a_unit : {0.8, 1.0, 1.25}) {
    const TwoPasses road = drive_twice(metres_a_unit, 0.0);
    const auto profile = ground_scale_profile(road.input, road.poses, road.tracks);
    ASSERT_TRUE(profile.found);
    ASSERT_EQ(profile.local.size(), road.poses.size());
    for (const LocalScale& local : profile.local)
      EXPECT_NEAR(std::exp(local.log_scale) / metres_a_unit, 1.0, 0.02) << local.keyframe;
  }
}

// Before loops are closed, the ground of the other pass has another height.
TEST(GroundScaleProfile, UsesNoCornersOfAnotherPass) {
  const TwoPasses road = drive_twice(1.0, 0.25);
  const auto profile = ground_scale_profile(road.input, road.poses, road.tracks);
  for (const LocalScale& local : profile.local)
    EXPECT_NEAR(local.log_scale, 0.0, 0.02) << local.keyframe;
}

// A wall beside the car has more corners than the ground: the odometry saw the ground around it.
TEST(GroundScaleProfile, StaysNearTheScaleThatTheOdometrySaw) {
  TwoPasses road = drive_twice(1.0, 0.0);
  Random random(5, "kerb");
  const std::size_t count = road.tracks.size();
  for (std::size_t i = 0; i < 3 * count; ++i) {
    JoinedTrack kerb = road.tracks[i % count];
    kerb.p_map->z() = 0.35 + random.normal(0.0, 0.005);
    road.tracks.push_back(kerb);
  }
  const auto largest = [&] {
    double most = 0.0;
    for (const auto& local : ground_scale_profile(road.input, road.poses, road.tracks).local)
      most = std::max(most, std::abs(local.log_scale));
    return most;
  };
  EXPECT_GT(largest(), 0.2);
  for (VoKeyframe& keyframe : road.input.odometry.keyframes) keyframe.ground_log_scale = 0.01;
  EXPECT_LT(largest(), 0.02);
}

TEST(CheckpointBlobs, KeepWhatTheOdometrySawOfTheGround) {
  VoResult odometry;
  odometry.keyframes.resize(3);
  odometry.keyframes[0].ground_log_scale = 0.25;
  odometry.keyframes[2].ground_log_scale = 0.0;
  odometry.keyframes[2].travelled_m = 4.5;
  VoResult back;
  for (std::size_t chunk = 0; chunk < keyframe_chunks(odometry); ++chunk)
    append_keyframes(keyframes_to_blob(odometry, chunk), back);
  ASSERT_EQ(back.keyframes.size(), 3U);
  EXPECT_EQ(back.keyframes[0].ground_log_scale, std::optional(0.25));
  EXPECT_EQ(back.keyframes[1].ground_log_scale, std::nullopt);
  EXPECT_EQ(back.keyframes[2].ground_log_scale, std::optional(0.0));
  EXPECT_EQ(back.keyframes[2].travelled_m, 4.5);
}

}  // namespace
}  // namespace roadbook
