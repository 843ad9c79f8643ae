#pragma once

#include "base/se3.hpp"
#include "sensors/rig.hpp"
#include "vo/keyframe_track.hpp"

namespace roadbook {

/// Whether a camera exposes at another time than the stamp says: late images or a rolling shutter.
[[nodiscard]] bool exposes_beside_stamp(const Rig& rig);

/// Returns the rig with each camera where it was when it exposed, seen from the vehicle at the
/// stamp: moved by `twist` (vehicle frame, [m/s, rad/s]) for `exposed_after_s`. Ignores
/// `rolling_shutter_s`.
[[nodiscard]] Rig rig_at_exposure(const Rig& rig, const Vector6d& twist);

/// Moves the corners of all keyframes to where they would have been seen if each camera had exposed
/// its whole image at the stamp, given `exposed_after_s` and `rolling_shutter_s`
/// (docs/design/mapping_method.md, "Cameras that expose beside the stamp").
///
/// The velocity of the car comes from the neighbouring keyframes, across a gap from the other one.
/// First moves `p_odom` of the tracks: points of a camera that is late by dt lie ahead by speed *
/// dt. Then moves each corner by the difference of its two projections. A corner without a place
/// gets the distance of the nearest corner of its image that has one. A corner that would leave the
/// image stays.
///
/// `half_rig`: cameras of the half-size images. Quadratic in the corners of an image;
/// deterministic.
void move_to_stamps(const Rig& half_rig, VoResult& odometry);

}  // namespace roadbook
