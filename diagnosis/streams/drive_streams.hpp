#pragma once

#include <vector>

#include "diagnosis/streams/streams.hpp"
#include "drive/drive.hpp"

namespace roadbook {

/// The streams of motion of a drive: reference poses, wheels, steering, gyro (turn rate about the
/// vehicle's z). Each sensor's stated time offset is applied to its stamps.
[[nodiscard]] MotionStreams motion_streams(const Drive& drive);
/// The same with other reference poses, ascending in time.
[[nodiscard]] MotionStreams motion_streams(const Drive& drive,
                                           const std::vector<TimedPose>& reference);

/// Whether anything but the reference poses tells of motion.
[[nodiscard]] bool records_motion(const MotionStreams& streams);

}  // namespace roadbook
