#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace roadbook {

// Rigid motions. Perturbations act on the right, T * exp(xi), translation before rotation:
// xi = (rho, phi). Covariances are of that xi.

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Cross-product matrix: skew(a) * b = a x b.
template <typename T>
Eigen::Matrix<T, 3, 3> skew(const Eigen::Matrix<T, 3, 1>& a) {
  Eigen::Matrix<T, 3, 3> m;
  m << T(0), -a.z(), a.y(), a.z(), T(0), -a.x(), -a.y(), a.x(), T(0);
  return m;
}

/// Rotation of the rotation vector `phi` [rad].
[[nodiscard]] Eigen::Matrix3d so3_exp(const Eigen::Vector3d& phi);
/// Rotation vector of R, of length <= pi.
[[nodiscard]] Eigen::Vector3d so3_log(const Eigen::Matrix3d& R);
/// Right Jacobian of SO(3): exp(phi + d) = exp(phi) exp(J_r(phi) d) to first order.
[[nodiscard]] Eigen::Matrix3d so3_right_jacobian(const Eigen::Vector3d& phi);
[[nodiscard]] Eigen::Matrix3d so3_right_jacobian_inverse(const Eigen::Vector3d& phi);

[[nodiscard]] Eigen::Isometry3d se3_exp(const Vector6d& xi);
[[nodiscard]] Vector6d se3_log(const Eigen::Isometry3d& T);
/// Adjoint: T * exp(xi) * T^-1 = exp(Ad_T * xi).
[[nodiscard]] Matrix6d se3_adjoint(const Eigen::Isometry3d& T);

/// Covariance of T_a_c = T_a_b * T_b_c, if the errors of T_a_b and T_b_c are independent.
[[nodiscard]] Matrix6d compose_covariance(const Matrix6d& cov_a_b,
                                          const Eigen::Isometry3d& T_b_c,
                                          const Matrix6d& cov_b_c);

/// Nearest rotation to a 3x3 matrix (polar decomposition).
[[nodiscard]] Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& m);

/// Heading [rad] of the x axis of `T_map_vehicle` in the map's xy plane.
[[nodiscard]] double heading_of(const Eigen::Isometry3d& T_map_vehicle);

/// Planar pose (x, y, heading [rad]) lifted to SE(3) with z = 0.
[[nodiscard]] Eigen::Isometry3d pose_from_planar(double x, double y, double heading);

/// Wraps an angle to (-pi, pi].
[[nodiscard]] double wrap_angle(double angle);

}  // namespace roadbook
