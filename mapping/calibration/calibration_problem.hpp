#pragma once

#include <ceres/loss_function.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "mapping/calibration/calibration_costs.hpp"
#include "mapping/optimisation/ceres_motion_cost.hpp"

namespace roadbook {

/// The calibration as a problem of Ceres: poses, points and errors of the sensors are unknown. The
/// data must outlive it.
class CalibrationProblem {
 public:
  /// `values`: where the columns start; `held`: columns that keep this value; `pixel_loss_width`
  /// and `ground_sigma_m`: CalibrationOptions.
  CalibrationProblem(const CalibrationData& data,
                     const Eigen::VectorXd& values,
                     const std::vector<std::uint8_t>& held,
                     double pixel_loss_width,
                     double ground_sigma_m);

  /// Minimises; false if Ceres finds no solution.
  bool solve(int max_iterations, const std::function<void(int)>& on_iteration);

  [[nodiscard]] Eigen::VectorXd values() const;
  void write_to(CalibrationData& data) const;

  /// Residuals and derivatives at the current values, each times the root of its robust weight.
  struct Linear {
    Eigen::VectorXd residuals;
    Eigen::MatrixXd columns;             ///< d residuals / d columns; zero for held columns
    Eigen::SparseMatrix<double> others;  ///< d residuals / d poses and points
    std::vector<int> clusters;           ///< of each residual; -1: of a prior
    int cluster_count = 0;
  };
  [[nodiscard]] Linear linear();

 private:
  void add_blocks(const CalibrationData& data, const std::vector<std::uint8_t>& held);
  void add_residuals(const CalibrationData& data, double ground_sigma_m);
  void add_residual(ceres::CostFunction* cost,
                    ceres::LossFunction* loss,
                    const std::vector<double*>& blocks,
                    int cluster);

  const CalibrationData& data_;
  std::vector<CameraBlock> cameras_;
  WheelBlock wheels_{};
  std::vector<PoseBlock> poses_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<std::uint8_t> held_;
  PoseManifold pose_manifold_;
  std::vector<std::unique_ptr<ceres::Manifold>> manifolds_;
  ceres::HuberLoss pixel_loss_;
  ceres::HuberLoss motion_loss_;
  ceres::Problem problem_;
  std::vector<ceres::ResidualBlockId> residual_blocks_;
  std::vector<int> cluster_of_block_;
  int clusters_ = 0;
};

}  // namespace roadbook
