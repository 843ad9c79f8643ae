#include "sim/world/blob.hpp"

#include <cmath>
#include <numbers>

namespace roadbook {

Polygon blob(const Eigen::Vector2d& centre, double radius, Random& random) {
  Polygon polygon;
  for (int i = 0; i < 9; ++i) {
    const double a = i * 2.0 * std::numbers::pi / 9.0;
    polygon.push_back(centre + radius * random.uniform(0.85, 1.15) *
                                   Eigen::Vector2d(std::cos(a), std::sin(a)));
  }
  return polygon;
}

}  // namespace roadbook
