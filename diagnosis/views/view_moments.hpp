#pragma once

#include <cstdint>
#include <vector>

#include "diagnosis/views/view_data.hpp"

namespace roadbook {

/// Speed, yaw rate, acceleration and wheel phases at stamps (ascending) from the wheels in windows
/// centred on them, so that the noise of a reading at the stamp itself does not enter; where the
/// wheels do not reach, speed and yaw rate from the poses about them.
[[nodiscard]] std::vector<ViewMoment> view_moments(const std::vector<std::int64_t>& stamps,
                                                   const std::vector<BundlePose>& poses,
                                                   const Drive& drive);

}  // namespace roadbook
