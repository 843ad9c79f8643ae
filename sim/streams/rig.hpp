#pragma once

#include "sensors/effects.hpp"
#include "sensors/rig.hpp"
#include "sim/scenario/scenario.hpp"

namespace roadbook {

/// The nominal rig: four fisheyes of 180 degrees on a compact car, one per cardinal direction:
/// cam0 front, cam1 left, cam2 rear, cam3 right.
[[nodiscard]] Rig make_rig(const CameraSpec& spec);

/// The real camera when the effects are switched on; `nominal` is the camera that the drive states.
struct RealCamera {
  Camera camera;
  Eigen::Isometry3d T_vehicle_camera = Eigen::Isometry3d::Identity();
  double latency_s = 0.0;  ///< an image stamped t shows the world at t - latency
  double rolling_shutter_s =
      0.0;                  ///< from the first row to the last; the stamp is that of the middle row
  double vignetting = 0.0;  ///< relative loss of light at the edge of the image
  double gain = 1.0;        ///< exposure
  double later_gain = 1.0;  ///< factor on it from the middle of the drive on
};

/// Geometry by `apply_camera_effects`; times and brightness by the effects of the same camera.
[[nodiscard]] RealCamera real_camera(const MountedCamera& nominal, const EffectSizes& effects);

}  // namespace roadbook
