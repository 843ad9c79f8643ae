#include "mapping/cameras/common_camera_errors.hpp"

#include <gtest/gtest.h>

#include "mapping/cameras/principal_point.hpp"
#include "tests/support/fisheye_rig.hpp"

namespace roadbook {
namespace {

// Two drives of one keyframe with the four cameras of a rig. Each camera sees one point, along its
// optical axis but for some degrees.
struct TwoDrives {
  MappingInput input;
  BundleStage stage;

  TwoDrives(const Rig& first, const Rig& second) {
    for (const Rig& rig : {first, second}) {
      const int session = static_cast<int>(input.half_rigs.size());
      stage.camera_base.push_back(static_cast<int>(stage.problem.cameras.size()));
      input.half_rigs.push_back(rig);
      input.session.push_back(session);
      input.has_wheels.push_back(true);
      input.odometry.keyframes.emplace_back();
      stage.problem.poses.push_back({pose_from_planar(5.0 * session, 1.0, 0.3), false});
      for (const MountedCamera& mounted : rig.cameras) {
        const int camera = static_cast<int>(stage.problem.cameras.size());
        const int point = static_cast<int>(stage.problem.points.size());
        const Eigen::Isometry3d T_map_camera =
            stage.problem.poses.back().T_map_vehicle * mounted.T_vehicle_camera;
        const Eigen::Vector3d seen(0.8, -0.5, 3.0);
        BundlePoint p;
        p.p_map = T_map_camera * seen;
        stage.problem.points.push_back(p);
        stage.problem.observations.push_back(
            {session, point, camera, mounted.camera.project(seen).value(), 0.6});
        stage.problem.cameras.push_back(mounted);
      }
    }
  }
  [[nodiscard]] Eigen::Vector2d from_axis(std::size_t observation) const {
    const BundleObservation& seen = stage.problem.observations[observation];
    return seen.pixel -
           principal_point(stage.problem.cameras[static_cast<std::size_t>(seen.camera)].camera);
  }
};

std::vector<CommonError> of_size(const std::vector<CommonError>& errors, CommonErrorSize size) {
  std::vector<CommonError> found;
  for (const CommonError& error : errors)
    if (error.size == size) found.push_back(error);
  return found;
}

TEST(CommonCameraErrors, DrivesOfOneCalibrationShareTheErrorOfTheirFocalLengths) {
  const TwoDrives drives(test::fisheye_rig(), test::fisheye_rig());
  const auto errors = common_errors_of({}, drives.input, drives.stage);
  ASSERT_EQ(errors.size(), 2U);
  const auto focal = of_size(errors, CommonErrorSize::kIfShown);
  ASSERT_EQ(focal.size(), 1U);
  for (std::size_t o = 0; o < 8; ++o)
    EXPECT_LT((focal[0].pixels[o] - 0.01 * drives.from_axis(o)).norm(), 1e-9) << o;
}

TEST(CommonCameraErrors, EachCalibrationHasFocalLengthsOfItsOwn) {
  Rig longer = test::fisheye_rig();
  for (MountedCamera& mounted : longer.cameras) mounted.camera.parameters[0] *= 1.1;
  const TwoDrives drives(test::fisheye_rig(), longer);
  const auto focal =
      of_size(common_errors_of({}, drives.input, drives.stage), CommonErrorSize::kIfShown);
  ASSERT_EQ(focal.size(), 2U);
  for (const CommonError& error : focal) {
    const bool is_first = error.pixels[0].norm() > 0.0;
    for (std::size_t o = 0; o < 8; ++o) {
      const bool own = (o < 4) == is_first;
      EXPECT_LT((error.pixels[o] - (own ? 0.01 : 0.0) * drives.from_axis(o)).norm(), 1e-9) << o;
    }
  }
}

// Corners lie above their objects in every image, always: the predicted pixels would be lower.
TEST(CommonCameraErrors, TheHeightOfCornersIsOneErrorOfAllDrives) {
  const TwoDrives drives(test::fisheye_rig(), test::fisheye_rig());
  const auto corners =
      of_size(common_errors_of({}, drives.input, drives.stage), CommonErrorSize::kKnown);
  ASSERT_EQ(corners.size(), 1U);
  for (const Eigen::Vector2d& shift : corners[0].pixels) {
    EXPECT_NEAR(shift.x(), 0.0, 1e-9);
    EXPECT_NEAR(shift.y(), corners[0].pixels[0].y(), 1e-9);
    EXPECT_GT(std::abs(shift.y()), 0.05);
    EXPECT_LT(std::abs(shift.y()), 0.3);
  }
}

// A doubt names a session and a camera of it: only the pixels of this camera move.
TEST(CommonCameraErrors, ADoubtMovesThePixelsOfItsCameraAlone) {
  const TwoDrives drives(test::fisheye_rig(), test::fisheye_rig());
  CameraErrors longer = CameraErrors::Zero();
  longer[range_of(CameraParameter::kFocal).first] = 0.02;
  const auto errors = of_size(
      common_errors_of({{1, 2, "focal length", "", "", {longer}}}, drives.input, drives.stage),
      CommonErrorSize::kAtLeast);
  ASSERT_EQ(errors.size(), 1U);
  for (std::size_t o = 0; o < 8; ++o)
    EXPECT_LT((errors[0].pixels[o] - (o == 6 ? 0.02 : 0.0) * drives.from_axis(o)).norm(), 1e-9)
        << o;
}

}  // namespace
}  // namespace roadbook
