#pragma once

#include <ceres/manifold.h>
#include <ceres/sized_cost_function.h>

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "base/se3.hpp"
#include "mapping/optimisation/pose_graph.hpp"

namespace roadbook {

// Residuals of relative poses for Ceres: the parameter block of a pose, its manifold, and the
// residual of mapping/optimisation/motion_residual.hpp as cost functions.

/// A pose as a parameter block: unit quaternion (x, y, z, w), then translation [m].
using PoseBlock = std::array<double, 7>;
[[nodiscard]] PoseBlock block_of(const Eigen::Isometry3d& T_map_vehicle);
[[nodiscard]] Eigen::Isometry3d pose_of(const double* block);

/// Right perturbations T * exp(xi), as everywhere in roadbook.
///
/// Cost functions give the derivative by xi in the first six columns of a pose's Jacobian and
/// zeros in the seventh; `PlusJacobian` is therefore the identity over a row of zeros.
class PoseManifold : public ceres::Manifold {
 public:
  [[nodiscard]] int AmbientSize() const override { return 7; }
  [[nodiscard]] int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  bool Minus(const double* y, const double* x, double* y_minus_x) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;
};

/// Matrix A with A^T A = `information`, which may be singular (a measurement of part of a pose).
[[nodiscard]] Matrix6d root_of(const Matrix6d& information);

/// Residual of a measured motion between two poses. Parameter blocks: pose `from`, pose `to`, and,
/// with `has_scale`, the factor on the measured translation.
class MotionCost : public ceres::CostFunction {
 public:
  /// `weight`, if given, multiplies the information; it may change between two solves and must
  /// outlive the cost function. A weight of 0 takes the motion out.
  MotionCost(const Eigen::Isometry3d& T_from_to,
             const Matrix6d& information,
             bool has_scale,
             const double* weight = nullptr);
  bool Evaluate(const double* const* parameters,
                double* residuals,
                double** jacobians) const override;

 private:
  Eigen::Isometry3d T_from_to_;
  Matrix6d root_;
  const double* weight_;
};

/// Residual of a measured motion and relative scale between two poses of unknown scale: six numbers
/// of `scaled_motion_residual`, then `(log s_to - log s_from - log_scale) / log_scale_sigma`.
/// Parameter blocks: pose `from`, pose `to`, and the logarithms of their scales. `weight` as for
/// MotionCost.
class ScaledMotionCost : public ceres::SizedCostFunction<7, 7, 7, 1, 1> {
 public:
  ScaledMotionCost(const RelativePose& edge, const double* weight);
  bool Evaluate(const double* const* parameters,
                double* residuals,
                double** jacobians) const override;

 private:
  Eigen::Isometry3d T_from_to_;
  Matrix6d root_;
  double log_scale_;
  double inverse_sigma_;  // of the relative scale; 0: not measured
  const double* weight_;
};

/// Residual of a pose known beforehand. Parameter block: the pose.
class PosePriorCost : public ceres::SizedCostFunction<6, 7> {
 public:
  PosePriorCost(const Eigen::Isometry3d& T_map_vehicle, const Matrix6d& information)
      : T_map_vehicle_(T_map_vehicle), root_(root_of(information)) {}
  bool Evaluate(const double* const* parameters,
                double* residuals,
                double** jacobians) const override;

 private:
  Eigen::Isometry3d T_map_vehicle_;
  Matrix6d root_;
};

/// Residual (scale - prior) / sigma of a factor known beforehand. Parameter block: the factor.
class ScalePriorCost : public ceres::SizedCostFunction<1, 1> {
 public:
  ScalePriorCost(double prior, double sigma) : prior_(prior), sigma_(sigma) {}
  bool Evaluate(const double* const* parameters,
                double* residuals,
                double** jacobians) const override;

 private:
  double prior_;
  double sigma_;
};

}  // namespace roadbook
