#pragma once

#include <ceres/sized_cost_function.h>

#include <Eigen/Core>
#include <array>

#include "mapping/calibration/calibration_columns.hpp"
#include "mapping/calibration/calibration_data.hpp"

namespace roadbook {

// Residuals of the calibration for Ceres. Parameter blocks of poses are those of
// mapping/optimisation/ceres_motion_cost.hpp.

/// Errors of one camera (rotation vector about its axes, focal length, delay) and of the wheels, in
/// the order of calibration_columns.hpp.
using CameraBlock = std::array<double, kColumnsOfCamera>;
using WheelBlock = std::array<double, kColumnsOfWheels>;

/// A pixel, over its standard deviation: predicted minus measured. With T the pose, d the delay and
/// xi the twist, the image shows the point from T exp((e - d) xi), e: `exposed_after_s` of the
/// camera. Parameter blocks: pose, point, camera.
class PixelCost : public ceres::SizedCostFunction<2, 7, 3, kColumnsOfCamera> {
 public:
  /// Keeps references; `twist` may change between two solves.
  PixelCost(const MountedCamera& mounted, const Vector6d& twist, const BundleObservation& view);
  bool Evaluate(const double* const* parameters,
                double* residuals,
                double** jacobians) const override;

 private:
  const MountedCamera& mounted_;
  const Vector6d& twist_;
  const BundleObservation& view_;
  Eigen::Vector2d centre_;
};

/// The height of a ground point in the frame of a pose, over its standard deviation. Parameter
/// blocks: pose, point.
class GroundCost : public ceres::SizedCostFunction<1, 7, 3> {
 public:
  explicit GroundCost(double sigma_m) : sigma_m_(sigma_m) {}
  bool Evaluate(const double* const* parameters,
                double* residuals,
                double** jacobians) const override;

 private:
  double sigma_m_;
};

/// The motion between two poses against that of the wheels with their errors corrected, normalised.
/// Parameter blocks: pose `from`, pose `to`, wheels.
class WheelCost : public ceres::SizedCostFunction<6, 7, 7, kColumnsOfWheels> {
 public:
  /// Keeps a reference. The readings know the motion as stated.
  WheelCost(const CalibrationMotion& motion, std::int64_t t_from_ns, std::int64_t t_to_ns);
  bool Evaluate(const double* const* parameters,
                double* residuals,
                double** jacobians) const override;

 private:
  [[nodiscard]] std::optional<PlanarMotion> motion(const double* wheels) const;

  const CalibrationMotion& motion_;
  std::int64_t t_from_ns_;
  std::int64_t t_to_ns_;
  Matrix6d root_;
};

}  // namespace roadbook
