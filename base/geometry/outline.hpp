#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <vector>

namespace roadbook {

/// Distance of a point from the straight line between `a` and `b`, in two or three dimensions.
template <typename Vector>
[[nodiscard]] double distance_to_segment(const Vector& p, const Vector& a, const Vector& b) {
  const Vector ab = b - a;
  const double length2 = ab.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * ab).norm();
}

/// Whether the ray from `p` along x crosses the edge from `a` to `b`. A point with an odd number of
/// crossings is inside (rule of even and odd).
[[nodiscard]] inline bool ray_crosses(const Eigen::Vector2d& p,
                                      const Eigen::Vector2d& a,
                                      const Eigen::Vector2d& b) {
  return (a.y() > p.y()) != (b.y() > p.y()) &&
         p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
}

/// Whether the closed outline contains the point. The corners run either way; the last one need not
/// repeat the first.
[[nodiscard]] inline bool is_inside(const std::vector<Eigen::Vector2d>& corners,
                                    const Eigen::Vector2d& p) {
  bool inside = false;
  for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++)
    if (ray_crosses(p, corners[i], corners[j])) inside = !inside;
  return inside;
}

}  // namespace roadbook
