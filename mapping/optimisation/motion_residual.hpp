#pragma once

#include <Eigen/Geometry>

#include "base/se3.hpp"

namespace roadbook {

// The residual of a measured relative pose, shared by pose graph and bundle adjustment.
//
// With the error E = Z^-1 * T_from^-1 * T_to, the residual is (translation of E, log of E's
// rotation): to first order the right perturbation of Z, whose information weighs it.

/// An estimated factor on measured translations: for wheels of uncertain radius, or for the scale
/// of a drive with one camera.
struct ScaleParameter {
  double value = 1.0;  ///< start value; after the adjustment the estimate
  double prior = 1.0;
  double prior_sigma = 0.02;
  bool fixed = false;
};

/// Residual and its derivatives by right perturbations of both poses and by the scale.
struct MotionResidual {
  Vector6d r;
  Matrix6d J_from;
  Matrix6d J_to;
  Vector6d J_scale;
};

/// Residual alone. `scale` multiplies the translation of the measured `T_from_to`.
[[nodiscard]] Vector6d motion_error(const Eigen::Isometry3d& T_map_from,
                                    const Eigen::Isometry3d& T_map_to,
                                    const Eigen::Isometry3d& T_from_to,
                                    double scale);
[[nodiscard]] MotionResidual motion_residual(const Eigen::Isometry3d& T_map_from,
                                             const Eigen::Isometry3d& T_map_to,
                                             const Eigen::Isometry3d& T_from_to,
                                             double scale);

/// Residual of a motion between poses of unknown scale, and its derivatives. In E = Z^-1 *
/// T_from^-1
/// * T_to, the motion of the poses [m] is divided by the metres a unit of `from`.
struct ScaledMotionResidual {
  Vector6d r;
  Matrix6d J_from;
  Matrix6d J_to;
  Vector6d J_log_scale;  ///< by the logarithm of metres a unit of `from`
};
[[nodiscard]] ScaledMotionResidual scaled_motion_residual(const Eigen::Isometry3d& T_map_from,
                                                          const Eigen::Isometry3d& T_map_to,
                                                          const Eigen::Isometry3d& T_from_to,
                                                          double log_scale);

}  // namespace roadbook
