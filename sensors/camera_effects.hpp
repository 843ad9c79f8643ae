#pragma once

#include "sensors/effects.hpp"
#include "sensors/rig.hpp"

namespace roadbook {

/// The real camera where the effects of `sizes` are on; `nominal` is the stated camera.
///
/// Of `camN.X` (or `cam.X` for all cameras), by `nominal.name`: focal: both focal lengths times
/// 1 + size. aspect: horizontal focal length times 1 + size / 2, vertical one times 1 - size / 2.
/// centre: principal point to the right and down by size [px] each; centre_x, centre_y: only to the
/// right, only down. distortion, distortion2: added to k1 and k2 (double sphere, which has none: to
/// alpha and xi). rotation, pitch, roll: T_vehicle_camera * R_y(rotation) R_x(pitch) R_z(roll)
/// [rad]; the camera looks further to its own right, further up, and is turned clockwise about its
/// axis. position, lateral, height: camera moved along the vehicle's x, y and z axis [m], positive
/// forward, to the left and up. `rig.X` then turns all cameras as one body about the axes of the
/// vehicle by R_z(-rotation) R_y(-pitch) R_x(roll): to the right, up, clockwise seen from behind.
/// rolling_shutter: added to that of the camera. latency of one camera (`camN.latency`): taken off
/// `exposed_after_s`. Brightness and a latency of all cameras change nothing here.
[[nodiscard]] MountedCamera apply_camera_effects(const MountedCamera& nominal,
                                                 const EffectSizes& sizes);

}  // namespace roadbook
