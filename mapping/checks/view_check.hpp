#pragma once

#include <vector>

#include "base/error.hpp"
#include "mapping/map.hpp"

namespace roadbook {

/// Contradictions between observations and what cameras at the poses would see: cameras whose
/// observations are all off, poses whose observations are off, landmarks that their camera cannot
/// see, landmarks that an image saw twice.
[[nodiscard]] std::vector<Problem> view_problems(const Map& map);

}  // namespace roadbook
