#include "mapping/cameras/camera_doubts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/random.hpp"
#include "mapping/cameras/principal_point.hpp"
#include "tests/support/fisheye_rig.hpp"

namespace roadbook {
namespace {

// A car with four fisheyes drives bends and straights between known points. The images are made
// with the true cameras and judged with the stated ones; corners have descriptors of their own.

constexpr double kStepM = 0.25;
constexpr double kSpeedMps = 3.0;
constexpr std::int64_t kStepNs = static_cast<std::int64_t>(kStepM / kSpeedMps * 1e9);

struct Recording {
  Rig truth = test::fisheye_rig();
  double late_s = 0.0;  // of camera 1
  std::vector<Eigen::Isometry3d> poses;
};

Eigen::Isometry3d next_pose(const Eigen::Isometry3d& pose, double step_m, std::size_t k) {
  const double curvature = 0.2 * std::sin(0.05 * static_cast<double>(k));
  return pose * pose_from_planar(step_m, 0.0, curvature * step_m);
}

std::vector<Eigen::Isometry3d> bends_and_straights(std::size_t count) {
  std::vector<Eigen::Isometry3d> poses(1, Eigen::Isometry3d::Identity());
  while (poses.size() < count) poses.push_back(next_pose(poses.back(), kStepM, poses.size()));
  return poses;
}

std::vector<Eigen::Vector3d> points_around(const std::vector<Eigen::Isometry3d>& poses,
                                           Random& random) {
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Isometry3d& pose : poses)
    for (int i = 0; i < 8; ++i)
      points.push_back(pose * Eigen::Vector3d(random.uniform(-9.0, 9.0), random.uniform(-9.0, 9.0),
                                              random.uniform(0.0, 3.0)));
  return points;
}

Features features_of(const MountedCamera& camera,
                     const Eigen::Isometry3d& T_map_vehicle,
                     const std::vector<Eigen::Vector3d>& points,
                     const std::vector<Descriptor>& descriptors,
                     Random& random) {
  Features features;
  const Eigen::Isometry3d T_camera_map = (T_map_vehicle * camera.T_vehicle_camera).inverse();
  for (std::size_t p = 0; p < points.size(); ++p) {
    const Eigen::Vector3d seen = T_camera_map * points[p];
    if (seen.norm() < 1.5 || seen.norm() > 12.0 || seen.z() < 0.1 * seen.norm()) continue;
    const auto pixel = camera.camera.project(seen);
    if (!pixel || !camera.camera.contains(*pixel, 2.0)) continue;
    const Eigen::Vector2d noise(0.2 * random.normal(), 0.2 * random.normal());
    features.pixels.push_back((*pixel + noise).cast<float>());
    features.descriptors.push_back(descriptors[p]);
    if (features.size() == 150) break;
  }
  return features;
}

MappingInput recorded(Recording& recording, std::uint64_t seed) {
  Random random(seed, "camera doubts");
  recording.poses = bends_and_straights(150);
  const auto points = points_around(recording.poses, random);
  std::vector<Descriptor> descriptors(points.size());
  for (Descriptor& descriptor : descriptors)
    for (std::uint8_t& byte : descriptor) byte = static_cast<std::uint8_t>(random.below(256));
  MappingInput input;
  input.half_rigs = {test::fisheye_rig()};
  input.has_wheels = {true};
  for (std::size_t k = 0; k < recording.poses.size(); ++k) {
    VoKeyframe keyframe;
    keyframe.frame = k;
    keyframe.t_ns = static_cast<std::int64_t>(k) * kStepNs;
    keyframe.after_gap = k == 0;
    for (std::size_t c = 0; c < recording.truth.cameras.size(); ++c) {
      const double back_m = c == 1 ? recording.late_s * kSpeedMps : 0.0;
      const Eigen::Isometry3d pose = next_pose(recording.poses[k], -back_m, k);
      keyframe.features.push_back(
          features_of(recording.truth.cameras[c], pose, points, descriptors, random));
      keyframe.tracks.emplace_back();
    }
    input.odometry.keyframes.push_back(std::move(keyframe));
    input.session.push_back(0);
  }
  return input;
}

// Fields of the doubts with their cameras: "1 rotation", and the text behind.
std::vector<CameraDoubt> doubts_of(Recording recording, std::uint64_t seed = 3) {
  const MappingInput input = recorded(recording, seed);
  return doubt_cameras(input, recording.poses);
}

void expect_only(const std::vector<CameraDoubt>& doubts,
                 int camera,
                 const std::string& field,
                 const std::string& text = {}) {
  ASSERT_EQ(doubts.size(), 1U);
  EXPECT_EQ(doubts[0].camera, camera);
  EXPECT_EQ(doubts[0].field, field) << doubts[0].got;
  EXPECT_NE(doubts[0].got.find(text), std::string::npos) << doubts[0].got;
}

TEST(CameraDoubts, RightCamerasAreNotDoubted) {
  for (std::uint64_t seed = 1; seed <= 2; ++seed) EXPECT_TRUE(doubts_of({}, seed).empty()) << seed;
}

TEST(CameraDoubts, NameTheCameraAndItsTurn) {
  for (int axis = 0; axis < 3; ++axis) {
    Recording recording;
    auto& R = recording.truth.cameras[2].T_vehicle_camera;
    const Eigen::Vector3d about = 0.035 * Eigen::Vector3d::Unit(axis);  // 2 degrees
    R.linear() = so3_exp(about) * R.linear();
    const std::array<std::string, 3> names = {"roll 2.", "pitch 2.", "yaw 2."};
    const auto doubts = doubts_of(recording);
    ASSERT_EQ(doubts.size(), 1U) << axis;
    EXPECT_EQ(doubts[0].camera, 2);
    EXPECT_EQ(doubts[0].field, "rotation") << doubts[0].got;
    EXPECT_TRUE(doubts[0].got.find(names[static_cast<std::size_t>(axis)]) != std::string::npos ||
                doubts[0].got.find("1.9") != std::string::npos)
        << doubts[0].got;
  }
}

TEST(CameraDoubts, NameTheFocalLength) {
  for (const double error : {0.02, -0.02}) {
    Recording recording;
    auto& p = recording.truth.cameras[0].camera.parameters;
    p[0] *= 1.0 + error;
    p[1] *= 1.0 + error;
    expect_only(doubts_of(recording), 0, "focal length", error > 0.0 ? "% longer" : "% shorter");
  }
}

TEST(CameraDoubts, NameThePosition) {
  Recording recording;
  recording.truth.cameras[3].T_vehicle_camera.translation().x() += 0.6;
  expect_only(doubts_of(recording), 3, "position", "0.6");
}

// Poses that bend a little look like a camera up to 0.24 m from its place.
TEST(CameraDoubts, SayNothingOfASmallMove) {
  Recording recording;
  recording.truth.cameras[3].T_vehicle_camera.translation().x() += 0.2;
  EXPECT_TRUE(doubts_of(recording).empty());
}

TEST(CameraDoubts, NameLateImages) {
  for (const double late_s : {0.02, -0.08}) {
    Recording recording;
    recording.late_s = late_s;
    expect_only(doubts_of(recording), 1, "time_offset", late_s > 0.0 ? "older" : "younger");
  }
}

// A size that exceeds what matters by half a standard deviation may well be smaller.
TEST(CameraDoubts, NeedASizeThatSurelyMatters) {
  Recording recording;
  recording.late_s = 0.02;
  const MappingInput input = recorded(recording, 3);
  const auto evidence = camera_evidence(input, vehicle_motion(input, recording.poses), 0);
  const Eigen::Index delay = range_of(CameraParameter::kDelay).first;
  const auto fit =
      std::find_if(evidence[1].fits.begin(), evidence[1].fits.end(),
                   [](const CameraFit& f) { return f.parameter == CameraParameter::kDelay; });
  ASSERT_NE(fit, evidence[1].fits.end());
  CameraDoubtOptions options;
  options.delay_s = std::abs(fit->errors[delay]) - 0.5 * fit->sigmas[delay];
  EXPECT_TRUE(doubt_cameras(input, recording.poses, options).empty());
  options.delay_s = std::abs(fit->errors[delay]) - 2.0 * fit->sigmas[delay];
  expect_only(doubt_cameras(input, recording.poses, options), 1, "time_offset");
}

TEST(CameraDoubts, NameExchangedCameras) {
  Recording recording;
  MappingInput input = recorded(recording, 3);
  for (VoKeyframe& keyframe : input.odometry.keyframes)
    std::swap(keyframe.features[1], keyframe.features[2]);
  const auto doubts = doubt_cameras(input, recording.poses);
  const auto& cameras = input.half_rigs[0].cameras;
  expect_only(doubts, 1, "images", cameras[1].name + " and " + cameras[2].name + " look exchanged");
}

TEST(CameraDoubts, NameFrozenImages) {
  Recording recording;
  MappingInput input = recorded(recording, 3);
  auto& keyframes = input.odometry.keyframes;
  for (std::size_t k = 80; k < keyframes.size(); ++k)
    keyframes[k].features[2] = keyframes[79].features[2];
  expect_only(doubt_cameras(input, recording.poses), 2, "images", "repeat");
}

TEST(CameraDoubts, OneCameraAloneIsNotDoubted) {
  Recording recording;
  recording.truth.cameras[0].camera.parameters[0] *= 1.05;
  MappingInput input = recorded(recording, 3);
  input.half_rigs[0].cameras.resize(1);
  for (VoKeyframe& keyframe : input.odometry.keyframes) keyframe.features.resize(1);
  EXPECT_TRUE(doubt_cameras(input, recording.poses).empty());
}

TEST(CameraDoubts, AreTheSameOnAnyNumberOfThreads) {
  Recording recording;
  recording.truth.cameras[1].camera.parameters[0] *= 1.02;
  recording.truth.cameras[1].camera.parameters[1] *= 1.02;
  const MappingInput input = recorded(recording, 4);
  CameraDoubtOptions one;
  one.num_threads = 1;
  CameraDoubtOptions four;
  four.num_threads = 4;
  const auto a = doubt_cameras(input, recording.poses, one);
  const auto b = doubt_cameras(input, recording.poses, four);
  ASSERT_EQ(a.size(), 1U);
  ASSERT_EQ(b.size(), 1U);
  EXPECT_EQ(a[0].got, b[0].got);
}

}  // namespace
}  // namespace roadbook
