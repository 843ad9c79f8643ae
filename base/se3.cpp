#include "base/se3.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace roadbook {
namespace {

constexpr double kSmallAngle = 1e-5;

// V of se3_exp: the translation of exp(rho, phi) is V(phi) * rho.
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& phi) { return so3_right_jacobian(-phi); }

}  // namespace

Eigen::Matrix3d so3_exp(const Eigen::Vector3d& phi) {
  const double angle = phi.norm();
  const Eigen::Matrix3d K = skew<double>(phi);
  if (angle < kSmallAngle) return Eigen::Matrix3d::Identity() + K + 0.5 * K * K;
  return Eigen::Matrix3d::Identity() + std::sin(angle) / angle * K +
         (1.0 - std::cos(angle)) / (angle * angle) * K * K;
}

Eigen::Vector3d so3_log(const Eigen::Matrix3d& R) {
  const Eigen::Quaterniond q(R);
  const double sine = q.vec().norm();
  const double angle = 2.0 * std::atan2(sine, std::abs(q.w()));
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  if (sine < 1e-9) return 2.0 * sign * q.vec();
  return sign * angle / sine * q.vec();
}

Eigen::Matrix3d so3_right_jacobian(const Eigen::Vector3d& phi) {
  const double angle = phi.norm();
  const Eigen::Matrix3d K = skew<double>(phi);
  if (angle < kSmallAngle) return Eigen::Matrix3d::Identity() - 0.5 * K + K * K / 6.0;
  const double a2 = angle * angle;
  return Eigen::Matrix3d::Identity() - (1.0 - std::cos(angle)) / a2 * K +
         (angle - std::sin(angle)) / (a2 * angle) * K * K;
}

Eigen::Matrix3d so3_right_jacobian_inverse(const Eigen::Vector3d& phi) {
  const double angle = phi.norm();
  const Eigen::Matrix3d K = skew<double>(phi);
  if (angle < kSmallAngle) return Eigen::Matrix3d::Identity() + 0.5 * K + K * K / 12.0;
  const double half = 0.5 * angle;
  const double c = (1.0 - half * std::cos(half) / std::sin(half)) / (angle * angle);
  return Eigen::Matrix3d::Identity() + 0.5 * K + c * K * K;
}

Eigen::Isometry3d se3_exp(const Vector6d& xi) {
  const Eigen::Vector3d phi = xi.tail<3>();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = so3_exp(phi);
  T.translation() = left_jacobian(phi) * xi.head<3>();
  return T;
}

Vector6d se3_log(const Eigen::Isometry3d& T) {
  Vector6d xi;
  const Eigen::Vector3d phi = so3_log(T.linear());
  xi.head<3>() = so3_right_jacobian_inverse(-phi) * T.translation();
  xi.tail<3>() = phi;
  return xi;
}

Matrix6d se3_adjoint(const Eigen::Isometry3d& T) {
  Matrix6d Ad = Matrix6d::Zero();
  Ad.topLeftCorner<3, 3>() = T.linear();
  Ad.bottomRightCorner<3, 3>() = T.linear();
  Ad.topRightCorner<3, 3>() = skew<double>(T.translation()) * T.linear();
  return Ad;
}

Matrix6d compose_covariance(const Matrix6d& cov_a_b,
                            const Eigen::Isometry3d& T_b_c,
                            const Matrix6d& cov_b_c) {
  const Matrix6d Ad = se3_adjoint(T_b_c.inverse());
  return Ad * cov_a_b * Ad.transpose() + cov_b_c;
}

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& m) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d U = svd.matrixU();
  if ((U * svd.matrixV().transpose()).determinant() < 0.0) U.col(2) *= -1.0;
  return U * svd.matrixV().transpose();
}

double heading_of(const Eigen::Isometry3d& T_map_vehicle) {
  return std::atan2(T_map_vehicle(1, 0), T_map_vehicle(0, 0));
}

Eigen::Isometry3d pose_from_planar(double x, double y, double heading) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = Eigen::Vector3d(x, y, 0.0);
  return T;
}

double wrap_angle(double angle) {
  const double wrapped = std::remainder(angle, 2.0 * std::numbers::pi);
  return wrapped <= -std::numbers::pi ? std::numbers::pi : wrapped;
}

}  // namespace roadbook
