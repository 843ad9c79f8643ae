#pragma once

#include <string>
#include <vector>

#include "diagnosis/streams/streams.hpp"

namespace roadbook {

/// A line for each stream of a plain log with values that no vehicle has (steering beyond a right
/// angle, turn rates beyond 10 rad/s, sizes of many metres): most likely the description states
/// another unit than the file has. Only a guess: a log may be of a strange vehicle.
[[nodiscard]] std::vector<std::string> implausible_values(const MotionStreams& streams);

}  // namespace roadbook
