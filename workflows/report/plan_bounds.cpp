#include "workflows/report/plan_bounds.hpp"

#include <algorithm>

namespace roadbook {

PlanBounds PlanBounds::around(const std::vector<Eigen::Vector2d>& points) {
  if (points.empty()) return {};
  PlanBounds bounds{points.front(), points.front()};
  for (const Eigen::Vector2d& p : points) {
    bounds.low = bounds.low.cwiseMin(p);
    bounds.high = bounds.high.cwiseMax(p);
  }
  const double size = std::max((bounds.high - bounds.low).maxCoeff(), 1.0);
  bounds.low.array() -= 0.05 * size;
  bounds.high.array() += 0.05 * size;
  return bounds;
}

}  // namespace roadbook
