#include "speedmap/property_map/ipm.hpp"

#include <Eigen/LU>
#include <cmath>

namespace roadbook {

RayHit hit_plane(const Eigen::Vector3d& ray_camera,
                 const Eigen::Isometry3d& T_world_camera,
                 const GroundPlane& plane) {
  const Eigen::Vector3d ray = T_world_camera.linear() * ray_camera;
  const Eigen::Vector3d t = T_world_camera.translation();
  RayHit hit;
  hit.lambda = plane.normal.dot(plane.point - t) / plane.normal.dot(ray);
  hit.point = t + hit.lambda * ray;
  return hit;
}

std::optional<Eigen::Vector3d> ground_point(const Camera& camera,
                                            const Eigen::Isometry3d& T_world_camera,
                                            const GroundPlane& plane,
                                            const Eigen::Vector2d& pixel) {
  const auto ray = camera.bearing(pixel);
  if (!ray) return std::nullopt;
  const RayHit hit = hit_plane(*ray, T_world_camera, plane);
  if (!hit.valid() || !hit.point.allFinite()) return std::nullopt;
  return hit.point;
}

std::optional<Eigen::Matrix<double, 3, 2>> ground_jacobian(const Camera& camera,
                                                           const Eigen::Isometry3d& T_world_camera,
                                                           const GroundPlane& plane,
                                                           const Eigen::Vector3d& point) {
  Matrix23d d_pixel_d_point;
  if (!camera.project(T_world_camera.inverse() * point, &d_pixel_d_point)) return std::nullopt;
  // Two directions within the plane; pixels move with them through the model, and the inverse of
  // that 2x2 matrix goes back.
  const Eigen::Vector3d n = plane.normal.normalized();
  const Eigen::Vector3d a = n.unitOrthogonal();
  Eigen::Matrix<double, 3, 2> in_plane;
  in_plane << a, n.cross(a);
  const Eigen::Matrix2d d_pixel = d_pixel_d_point * T_world_camera.linear().transpose() * in_plane;
  const double determinant = d_pixel.determinant();
  if (!std::isfinite(determinant) || determinant == 0.0) return std::nullopt;
  return in_plane * d_pixel.inverse();
}

Eigen::Vector3d literal_ground_point(const Eigen::Vector3d& ray_camera,
                                     const Eigen::Isometry3d& T_world_camera,
                                     const GroundPlane& plane) {
  // "T a" of footnote 3 moves the ray like a point, and so the camera's place is scaled with it.
  const Eigen::Vector3d moved = T_world_camera * ray_camera;
  return plane.normal.dot(plane.point) / plane.normal.dot(moved) * moved;
}

}  // namespace roadbook
