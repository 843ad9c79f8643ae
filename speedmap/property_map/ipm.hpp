#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "sensors/camera.hpp"

namespace roadbook {

// Inverse perspective mapping: pixel to point on the ground, for any camera model [SPM, eq. 4]. The
// equation is corrected to x = t + l R d with l = n.(r - t) / (n.R d). As printed, the camera's
// position is scaled with the ray, and every pixel maps to the origin of a ground at z = 0.

/// Points x with normal . x = normal . point; the normal need not be of unit length.
struct GroundPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
};

/// Where a ray from the camera meets a plane.
struct RayHit {
  double lambda = 0.0;  ///< in lengths of the ray; behind the camera where <= 0
  Eigen::Vector3d point = Eigen::Vector3d::Zero();

  [[nodiscard]] bool valid() const { return lambda > 0.0; }
};

/// Intersects a ray with a plane. `ray_camera`: direction in the camera frame, of any length. A ray
/// parallel to the plane gives a lambda that is not finite (and not valid).
[[nodiscard]] RayHit hit_plane(const Eigen::Vector3d& ray_camera,
                               const Eigen::Isometry3d& T_world_camera,
                               const GroundPlane& plane);

/// The point of the plane that `pixel` shows, in the world frame. Empty for a pixel outside the
/// domain of the camera model or above the horizon.
[[nodiscard]] std::optional<Eigen::Vector3d> ground_point(const Camera& camera,
                                                          const Eigen::Isometry3d& T_world_camera,
                                                          const GroundPlane& plane,
                                                          const Eigen::Vector2d& pixel);

/// Derivative of the ground point by the pixel: d point / d (u, v) [m/px], from the Jacobian of the
/// camera model. Its determinant is the ground area of a pixel. `point`: a result of
/// `ground_point`.
[[nodiscard]] std::optional<Eigen::Matrix<double, 3, 2>> ground_jacobian(
    const Camera& camera,
    const Eigen::Isometry3d& T_world_camera,
    const GroundPlane& plane,
    const Eigen::Vector3d& point);

/// Equation 4 as printed, with its defects, for comparison.
[[nodiscard]] Eigen::Vector3d literal_ground_point(const Eigen::Vector3d& ray_camera,
                                                   const Eigen::Isometry3d& T_world_camera,
                                                   const GroundPlane& plane);

}  // namespace roadbook
