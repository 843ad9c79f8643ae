#pragma once

#include <cstdint>
#include <vector>

#include "diagnosis/views/view_data.hpp"

namespace roadbook {

/// Motion of the car at the stamps (ascending): speed, yaw rate, acceleration and wheel phases from
/// wheel readings in windows centred on each stamp, so that the noise of the nearest reading has
/// little influence. Where the wheels have no readings, speed and yaw rate come from the
/// neighbouring poses.
[[nodiscard]] std::vector<ViewMoment> view_moments(const std::vector<std::int64_t>& stamps,
                                                   const std::vector<BundlePose>& poses,
                                                   const Drive& drive);

}  // namespace roadbook
