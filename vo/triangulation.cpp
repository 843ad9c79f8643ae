#include "vo/triangulation.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace roadbook {
namespace {

double largest_parallax(std::span<const Ray> rays) {
  double smallest_cosine = 1.0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    // First and last rays span the track; all pairs would be quadratic in its length.
    smallest_cosine = std::min({smallest_cosine, rays.front().direction.dot(rays[i].direction),
                                rays.back().direction.dot(rays[i].direction)});
  }
  return std::acos(std::clamp(smallest_cosine, -1.0, 1.0));
}

// Weighted sum of squared distances to the rays; weight 1/range^2 turns distances into angles.
std::optional<Eigen::Vector3d> nearest_point(std::span<const Ray> rays,
                                             const Eigen::Vector3d* near) {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const Ray& ray : rays) {
    const double weight = near ? 1.0 / std::max(1e-6, (*near - ray.origin).squaredNorm()) : 1.0;
    const Eigen::Matrix3d P =
        weight * (Eigen::Matrix3d::Identity() - ray.direction * ray.direction.transpose());
    H += P;
    b += P * ray.origin;
  }
  const Eigen::LDLT<Eigen::Matrix3d> ldlt(H);
  if (ldlt.info() != Eigen::Success || !(ldlt.vectorD().minCoeff() > 0.0)) return std::nullopt;
  const Eigen::Vector3d p = ldlt.solve(b);
  if (!p.allFinite()) return std::nullopt;
  return p;
}

}  // namespace

std::optional<TriangulatedPoint> triangulate(std::span<const Ray> rays, double min_parallax_rad) {
  if (rays.size() < 2) return std::nullopt;
  TriangulatedPoint result;
  result.parallax_rad = largest_parallax(rays);
  if (!(result.parallax_rad >= min_parallax_rad)) return std::nullopt;
  auto p = nearest_point(rays, nullptr);
  for (int i = 0; i < 3 && p; ++i) p = nearest_point(rays, &*p);
  if (!p) return std::nullopt;
  for (const Ray& ray : rays) {
    const Eigen::Vector3d to_point = *p - ray.origin;
    const double range = to_point.norm();
    const double cosine = to_point.dot(ray.direction) / range;
    if (!(range > 0.05) || !(cosine > 0.0)) return std::nullopt;
    result.max_error_rad = std::max(result.max_error_rad, std::acos(std::min(1.0, cosine)));
  }
  result.p_world = *p;
  return result;
}

}  // namespace roadbook
