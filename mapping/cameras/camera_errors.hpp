#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "base/se3.hpp"

namespace roadbook {

/// Groups of calibration parameters, each fitted alone.
enum class CameraParameter { kRotation, kFocal, kCentre, kPosition, kDelay };
inline constexpr std::array kCameraParameters = {
    CameraParameter::kRotation, CameraParameter::kFocal, CameraParameter::kCentre,
    CameraParameter::kPosition, CameraParameter::kDelay};

/// Sizes of all parameters: rotation vector about the vehicle's axes [rad] (0 to 2), relative focal
/// length (3), principal point [px, half-size image] (4, 5), position [m, vehicle] (6 to 8; the
/// height shows in no turn and is not fitted), time that the images are late by [s] (9).
using CameraErrors = Eigen::Matrix<double, 10, 1>;

/// Poses of the vehicle and their changes, by keyframe.
struct KeyframeMotion {
  std::vector<Eigen::Isometry3d> T_map_vehicle;
  std::vector<Vector6d> twist;  ///< velocity [m/s] and turn rate [rad/s] in the vehicle frame
};

}  // namespace roadbook
