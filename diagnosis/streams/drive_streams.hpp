#pragma once

#include <vector>

#include "diagnosis/streams/streams.hpp"
#include "drive/drive.hpp"

namespace roadbook {

/// The motion streams of a drive: reference poses, wheels, steering and gyro (turn rate about the
/// vehicle's z axis). The stated time offset of each sensor is applied to its stamps.
[[nodiscard]] MotionStreams motion_streams(const Drive& drive);
/// The same with `reference` in place of the drive's reference poses; they ascend in time.
[[nodiscard]] MotionStreams motion_streams(const Drive& drive,
                                           const std::vector<TimedPose>& reference);

/// True if the streams hold motion readings besides the reference poses.
[[nodiscard]] bool records_motion(const MotionStreams& streams);

}  // namespace roadbook
