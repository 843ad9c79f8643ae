#pragma once

#include <vector>

#include "mapping/map.hpp"

namespace roadbook {

/// Number of the part of each keyframe: odometry without a gap, accepted loops or at least ten
/// common landmarks join the keyframes of a part. Parts count from 0, by their first keyframe.
[[nodiscard]] std::vector<int> joined_parts(const Map& map);

}  // namespace roadbook
