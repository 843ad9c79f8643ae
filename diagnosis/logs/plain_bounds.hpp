#pragma once

#include <string>
#include <vector>

#include "diagnosis/streams/streams.hpp"

namespace roadbook {

/// Warnings for streams of a plain log with values that no vehicle has: steering beyond a right
/// angle, turn rates beyond 10 rad/s, sizes of many metres. The likely reason is a wrong unit in
/// the description. It is a warning only, because unusual vehicles exist.
[[nodiscard]] std::vector<std::string> implausible_values(const MotionStreams& streams);

}  // namespace roadbook
