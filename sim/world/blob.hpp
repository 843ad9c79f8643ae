#pragma once

#include "base/random.hpp"
#include "sim/world/paint.hpp"

namespace roadbook {

/// An irregular polygon of nine corners, about `radius` [m] large.
[[nodiscard]] Polygon blob(const Eigen::Vector2d& centre, double radius, Random& random);

}  // namespace roadbook
