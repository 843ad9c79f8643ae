#pragma once

#include "base/se3.hpp"
#include "sensors/rig.hpp"
#include "vo/keyframe_track.hpp"

namespace roadbook {

/// Whether a camera exposes at another time than the stamp says: late images or a rolling shutter.
[[nodiscard]] bool exposes_beside_stamp(const Rig& rig);

/// The rig with each camera where it stood on the vehicle's way when it exposed: moved by `twist`
/// (vehicle frame, [m/s, rad/s]) over `exposed_after_s`. For a rolling shutter: the middle row.
[[nodiscard]] Rig rig_at_exposure(const Rig& rig, const Vector6d& twist);

/// Moves the corners of all keyframes to where cameras that expose whole images at the stamp of
/// their instant would see them, given `MountedCamera::exposed_after_s` and `rolling_shutter_s`.
///
/// While the camera waits, the car moves on with the velocity that the neighbouring keyframes tell
/// (in SE(3); across a gap that of the other neighbour). A corner moves by the difference of its
/// two projections. One without a place is taken to be as far away as the nearest corner of the
/// image that has one. Corners that leave the image stay. Then `p_odom` of the tracks is moved with
/// them: points of a camera that is late by dt lie ahead by speed * dt.
///
/// `half_rig`: cameras of the half-size images. Quadratic in the corners of an image;
/// deterministic.
void move_to_stamps(const Rig& half_rig, VoResult& odometry);

}  // namespace roadbook
