#include "mapping/optimisation/ceres_motion_cost.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "mapping/optimisation/motion_residual.hpp"

namespace roadbook {
namespace {

using Jacobian67 = Eigen::Matrix<double, 6, 7, Eigen::RowMajor>;
using Jacobian76 = Eigen::Matrix<double, 7, 6, Eigen::RowMajor>;

void write_jacobian(const Matrix6d& J, double* jacobian) {
  Eigen::Map<Jacobian67> out(jacobian);
  out.leftCols<6>() = J;
  out.col(6).setZero();
}

}  // namespace

PoseBlock block_of(const Eigen::Isometry3d& T_map_vehicle) {
  PoseBlock block;
  Eigen::Map<Eigen::Quaterniond>(block.data()) =
      Eigen::Quaterniond(T_map_vehicle.linear()).normalized();
  Eigen::Map<Eigen::Vector3d>(block.data() + 4) = T_map_vehicle.translation();
  return block;
}

Eigen::Isometry3d pose_of(const double* block) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::Map<const Eigen::Quaterniond>(block).toRotationMatrix();
  T.translation() = Eigen::Map<const Eigen::Vector3d>(block + 4);
  return T;
}

bool PoseManifold::Plus(const double* x, const double* delta, double* x_plus_delta) const {
  const Eigen::Isometry3d T = pose_of(x) * se3_exp(Eigen::Map<const Vector6d>(delta));
  const PoseBlock block = block_of(T);
  std::copy(block.begin(), block.end(), x_plus_delta);
  return true;
}

bool PoseManifold::PlusJacobian(const double* /*x*/, double* jacobian) const {
  Eigen::Map<Jacobian76>(jacobian).setIdentity();
  return true;
}

bool PoseManifold::Minus(const double* y, const double* x, double* y_minus_x) const {
  Eigen::Map<Vector6d> out(y_minus_x);
  out = se3_log(pose_of(x).inverse() * pose_of(y));
  return true;
}

bool PoseManifold::MinusJacobian(const double* /*x*/, double* jacobian) const {
  Eigen::Map<Jacobian67>(jacobian).setIdentity();
  return true;
}

Matrix6d root_of(const Matrix6d& information) {
  const Eigen::LLT<Matrix6d> llt(information);
  if (llt.info() == Eigen::Success) return llt.matrixU();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(information);
  return eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() *
         eigen.eigenvectors().transpose();
}

MotionCost::MotionCost(const Eigen::Isometry3d& T_from_to,
                       const Matrix6d& information,
                       bool has_scale,
                       const double* weight)
    : T_from_to_(T_from_to), root_(root_of(information)), weight_(weight) {
  set_num_residuals(6);
  *mutable_parameter_block_sizes() = {7, 7};
  if (has_scale) mutable_parameter_block_sizes()->push_back(1);
}

bool MotionCost::Evaluate(const double* const* parameters,
                          double* residuals,
                          double** jacobians) const {
  const bool has_scale = parameter_block_sizes().size() > 2;
  const double scale = has_scale ? parameters[2][0] : 1.0;
  const Eigen::Isometry3d from = pose_of(parameters[0]);
  const Eigen::Isometry3d to = pose_of(parameters[1]);
  const Matrix6d root = (weight_ != nullptr ? std::sqrt(*weight_) : 1.0) * root_;
  Eigen::Map<Vector6d> r(residuals);
  if (jacobians == nullptr) {
    r = root * motion_error(from, to, T_from_to_, scale);
    return true;
  }
  const MotionResidual e = motion_residual(from, to, T_from_to_, scale);
  r = root * e.r;
  if (jacobians[0] != nullptr) write_jacobian(root * e.J_from, jacobians[0]);
  if (jacobians[1] != nullptr) write_jacobian(root * e.J_to, jacobians[1]);
  if (has_scale && jacobians[2] != nullptr) {
    Eigen::Map<Vector6d> J_scale(jacobians[2]);
    J_scale = root * e.J_scale;
  }
  return true;
}

ScaledMotionCost::ScaledMotionCost(const RelativePose& edge, const double* weight)
    : T_from_to_(edge.T_from_to),
      root_(root_of(edge.information)),
      log_scale_(edge.log_scale),
      inverse_sigma_(edge.log_scale_sigma > 0.0 ? 1.0 / edge.log_scale_sigma : 0.0),
      weight_(weight) {}

bool ScaledMotionCost::Evaluate(const double* const* parameters,
                                double* residuals,
                                double** jacobians) const {
  const ScaledMotionResidual e = scaled_motion_residual(
      pose_of(parameters[0]), pose_of(parameters[1]), T_from_to_, parameters[2][0]);
  const double factor = weight_ != nullptr ? std::sqrt(*weight_) : 1.0;
  const Matrix6d root = factor * root_;
  Eigen::Map<Vector6d> r(residuals);
  r = root * e.r;
  residuals[6] = factor * inverse_sigma_ * (parameters[3][0] - parameters[2][0] - log_scale_);
  if (jacobians == nullptr) return true;
  for (int block = 0; block < 2; ++block) {
    if (jacobians[block] == nullptr) continue;
    Eigen::Map<Eigen::Matrix<double, 7, 7, Eigen::RowMajor>> J(jacobians[block]);
    J.setZero();
    J.topLeftCorner<6, 6>() = root * (block == 0 ? e.J_from : e.J_to);
  }
  if (jacobians[2] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 7, 1>> J(jacobians[2]);
    J.head<6>() = root * e.J_log_scale;
    J[6] = -factor * inverse_sigma_;
  }
  if (jacobians[3] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 7, 1>> J(jacobians[3]);
    J.setZero();
    J[6] = factor * inverse_sigma_;
  }
  return true;
}

bool PosePriorCost::Evaluate(const double* const* parameters,
                             double* residuals,
                             double** jacobians) const {
  const MotionResidual e =
      motion_residual(Eigen::Isometry3d::Identity(), pose_of(parameters[0]), T_map_vehicle_, 1.0);
  Eigen::Map<Vector6d> r(residuals);
  r = root_ * e.r;
  if (jacobians != nullptr && jacobians[0] != nullptr) write_jacobian(root_ * e.J_to, jacobians[0]);
  return true;
}

bool ScalePriorCost::Evaluate(const double* const* parameters,
                              double* residuals,
                              double** jacobians) const {
  residuals[0] = (parameters[0][0] - prior_) / sigma_;
  if (jacobians != nullptr && jacobians[0] != nullptr) jacobians[0][0] = 1.0 / sigma_;
  return true;
}

}  // namespace roadbook
