#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "base/se3.hpp"
#include "mapping/cameras/camera_tracks.hpp"
#include "sensors/rig.hpp"

namespace roadbook {

// Errors of one camera's calibration, found from its tracks while the vehicle's poses are held.
// Points are eliminated: each track stands for itself.

/// Groups of calibration parameters, each fitted alone.
enum class CameraParameter { kRotation, kFocal, kCentre, kPosition, kDelay };
inline constexpr std::array kCameraParameters = {
    CameraParameter::kRotation, CameraParameter::kFocal, CameraParameter::kCentre,
    CameraParameter::kPosition, CameraParameter::kDelay};

/// Sizes of all parameters: rotation vector about the vehicle's axes [rad] (0 to 2), relative focal
/// length (3), principal point [px, half-size image] (4, 5), position [m, vehicle] (6 to 8; the
/// height shows in no turn and is not fitted), time that the images are late by [s] (9).
using CameraErrors = Eigen::Matrix<double, 10, 1>;

/// First index and number of a group's parameters in CameraErrors.
struct ParameterRange {
  Eigen::Index first = 0;
  Eigen::Index count = 0;
};
[[nodiscard]] ParameterRange range_of(CameraParameter parameter);

/// Poses of the vehicle and their changes, by keyframe.
struct VehicleMotion {
  std::vector<Eigen::Isometry3d> T_map_vehicle;
  std::vector<Vector6d> twist;  ///< velocity [m/s] and turn rate [rad/s] in the vehicle frame
};
/// Motion through the poses; the twist is that between the neighbouring keyframes of a session.
[[nodiscard]] VehicleMotion vehicle_motion(const MappingInput& input,
                                           const std::vector<Eigen::Isometry3d>& T_map_vehicle);

/// Share of the tracks that fit the camera as calibrated, to `inlier_px` (half-size image); -1
/// without tracks.
[[nodiscard]] double fitting_share(const MountedCamera& camera,
                                   const std::vector<CameraTrack>& tracks,
                                   const VehicleMotion& motion,
                                   double inlier_px);

struct CameraFit {
  CameraParameter parameter = CameraParameter::kRotation;
  CameraErrors errors =
      CameraErrors::Zero();  ///< of the calibration; others than the group's are 0
  CameraErrors sigmas = CameraErrors::Zero();  ///< cluster-robust over stretches
  double cost = 0.0;                           ///< robust, of all tracks
  double gain = 0.0;  ///< share of `cost_as_calibrated` that goes away; the caller sets it
};

/// Robust cost of all tracks without a fit, solved as often as in a fit, so that the two compare.
[[nodiscard]] double cost_as_calibrated(const MountedCamera& camera,
                                        const std::vector<CameraTrack>& tracks,
                                        const VehicleMotion& motion);

/// Fits one group of parameters. Robust against wrong matches. Deterministic.
[[nodiscard]] CameraFit fit_camera(const MountedCamera& camera,
                                   const std::vector<CameraTrack>& tracks,
                                   const VehicleMotion& motion,
                                   CameraParameter parameter);

}  // namespace roadbook
