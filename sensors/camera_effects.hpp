#pragma once

#include "sensors/effects.hpp"
#include "sensors/rig.hpp"

namespace roadbook {

/// The real camera where the effects of `sizes` are on; `nominal` is the stated camera.
///
/// Of `camN.X` (or `cam.X` for all cameras), by `nominal.name`: focal: both focal lengths times
/// 1 + size. centre: principal point to the right and down by size [px] each. distortion: added to
/// k1 (double sphere, which has none: to alpha). rotation, pitch, roll: T_vehicle_camera *
/// R_y(rotation) R_x(pitch) R_z(roll) [rad]; the camera looks further to its own right, further up,
/// and is turned clockwise about its axis. position: camera further forward on the vehicle's x axis
/// [m]. Latency, shutter and brightness concern the image, not the camera, and change nothing here.
[[nodiscard]] MountedCamera apply_camera_effects(const MountedCamera& nominal,
                                                 const EffectSizes& sizes);

}  // namespace roadbook
