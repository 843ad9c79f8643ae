#pragma once

#include <Eigen/Geometry>

#include "base/se3.hpp"

namespace roadbook {

/// Information of a vector of three translations [m] and three rotations [rad] with these standard
/// deviations.
[[nodiscard]] inline Matrix6d information_of_sigmas(double sigma_m, double sigma_rad) {
  Matrix6d information = Matrix6d::Zero();
  information.diagonal() << Eigen::Vector3d::Constant(1.0 / (sigma_m * sigma_m)),
      Eigen::Vector3d::Constant(1.0 / (sigma_rad * sigma_rad));
  return information;
}

/// Information of the motion between two successive poses of a map, taken as odometry that may
/// drift: 5 mm and 1 % of the way, 2 mrad.
[[nodiscard]] inline Matrix6d step_information(const Eigen::Isometry3d& T_from_to) {
  constexpr double kStepSigmaM = 0.005;
  constexpr double kStepSigmaShare = 0.01;
  constexpr double kStepSigmaRad = 0.002;
  return information_of_sigmas(kStepSigmaM + kStepSigmaShare * T_from_to.translation().norm(),
                               kStepSigmaRad);
}

}  // namespace roadbook
