#include "mapping/optimisation/motion_residual.hpp"

#include <cmath>

namespace roadbook {

Vector6d motion_error(const Eigen::Isometry3d& T_map_from,
                      const Eigen::Isometry3d& T_map_to,
                      const Eigen::Isometry3d& T_from_to,
                      double scale) {
  const Eigen::Matrix3d R_z = T_from_to.linear();
  const Eigen::Matrix3d R_from = T_map_from.linear();
  const Eigen::Vector3d moved =
      R_from.transpose() * (T_map_to.translation() - T_map_from.translation());
  Vector6d r;
  r.head<3>() = R_z.transpose() * (moved - scale * T_from_to.translation());
  r.tail<3>() = so3_log(R_z.transpose() * R_from.transpose() * T_map_to.linear());
  return r;
}

MotionResidual motion_residual(const Eigen::Isometry3d& T_map_from,
                               const Eigen::Isometry3d& T_map_to,
                               const Eigen::Isometry3d& T_from_to,
                               double scale) {
  const Eigen::Matrix3d R_zt = T_from_to.linear().transpose();
  const Eigen::Matrix3d R_from_to = T_map_from.linear().transpose() * T_map_to.linear();
  const Eigen::Vector3d moved =
      T_map_from.linear().transpose() * (T_map_to.translation() - T_map_from.translation());
  MotionResidual m;
  m.r.head<3>() = R_zt * (moved - scale * T_from_to.translation());
  m.r.tail<3>() = so3_log(R_zt * R_from_to);
  const Eigen::Matrix3d J_log = so3_right_jacobian_inverse(m.r.tail<3>());
  m.J_from.setZero();
  m.J_from.topLeftCorner<3, 3>() = -R_zt;
  m.J_from.topRightCorner<3, 3>() = R_zt * skew<double>(moved);
  m.J_from.bottomRightCorner<3, 3>() = -J_log * R_from_to.transpose();
  m.J_to.setZero();
  m.J_to.topLeftCorner<3, 3>() = R_zt * R_from_to;
  m.J_to.bottomRightCorner<3, 3>() = J_log;
  m.J_scale.head<3>() = -R_zt * T_from_to.translation();
  m.J_scale.tail<3>().setZero();
  return m;
}

ScaledMotionResidual scaled_motion_residual(const Eigen::Isometry3d& T_map_from,
                                            const Eigen::Isometry3d& T_map_to,
                                            const Eigen::Isometry3d& T_from_to,
                                            double log_scale) {
  const double unit_m = std::exp(log_scale);
  const MotionResidual m = motion_residual(T_map_from, T_map_to, T_from_to, unit_m);
  ScaledMotionResidual scaled{m.r, m.J_from, m.J_to, Vector6d::Zero()};
  scaled.r.head<3>() /= unit_m;
  scaled.J_from.topRows<3>() /= unit_m;
  scaled.J_to.topRows<3>() /= unit_m;
  scaled.J_log_scale.head<3>() =
      -scaled.r.head<3>() - T_from_to.linear().transpose() * T_from_to.translation();
  return scaled;
}

}  // namespace roadbook
