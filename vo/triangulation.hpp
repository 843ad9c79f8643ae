#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>

namespace roadbook {

/// A ray from a camera's centre, both in the world frame.
struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;  ///< unit
};

struct TriangulatedPoint {
  Eigen::Vector3d p_world;
  double parallax_rad = 0.0;   ///< largest angle between two of the rays
  double max_error_rad = 0.0;  ///< largest angle between a ray and the direction to the point
};

/// Returns the point nearest to all rays in angle: linear least squares, then Gauss-Newton on the
/// angles. Empty with fewer than two rays, if no two rays differ by `min_parallax_rad`, or if the
/// point lies behind a ray's origin.
[[nodiscard]] std::optional<TriangulatedPoint> triangulate(std::span<const Ray> rays,
                                                           double min_parallax_rad);

}  // namespace roadbook
