#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "mapping/cameras/camera_errors.hpp"
#include "mapping/cameras/camera_tracks.hpp"
#include "sensors/rig.hpp"

namespace roadbook {

// Errors of one camera's calibration, found from its tracks while the vehicle's poses are held.
// Points are eliminated: each track is independent.

/// First index and number of a group's parameters in CameraErrors.
struct ParameterRange {
  Eigen::Index first = 0;
  Eigen::Index count = 0;
};
[[nodiscard]] ParameterRange range_of(CameraParameter parameter);

/// Motion through the poses; the twist is that between the neighbouring keyframes of a session.
[[nodiscard]] KeyframeMotion vehicle_motion(const MappingInput& input,
                                            const std::vector<Eigen::Isometry3d>& T_map_vehicle);

/// Share of the tracks that fit the camera as calibrated, to `inlier_px` (half-size image); -1
/// without tracks.
[[nodiscard]] double fitting_share(const MountedCamera& camera,
                                   const std::vector<CameraTrack>& tracks,
                                   const KeyframeMotion& motion,
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
                                        const KeyframeMotion& motion);

/// Fits one group of parameters. Robust against wrong matches. Deterministic.
[[nodiscard]] CameraFit fit_camera(const MountedCamera& camera,
                                   const std::vector<CameraTrack>& tracks,
                                   const KeyframeMotion& motion,
                                   CameraParameter parameter);

}  // namespace roadbook
