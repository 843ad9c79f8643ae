#pragma once

#include "base/random.hpp"
#include "sim/world/paint.hpp"

namespace roadbook {

/// Something without a shape of its own, about so large [m]: a polygon of nine corners.
[[nodiscard]] Polygon blob(const Eigen::Vector2d& centre, double radius, Random& random);

}  // namespace roadbook
