#pragma once

#include <vector>

#include "base/error.hpp"
#include "mapping/map.hpp"

namespace roadbook {

/// Covariances that are zero, or smaller than the observations and the wheels allow if all their
/// errors are independent and all other poses are known. This is the smallest covariance that there
/// can be. Linear in the number of observations.
[[nodiscard]] std::vector<Problem> covariance_problems(const Map& map);

}  // namespace roadbook
