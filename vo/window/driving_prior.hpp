#pragma once

#include "base/se3.hpp"

namespace roadbook {

/// Information of a motion over `distance_m` [m] that holds for any car without wheels' odometry:
/// it neither slides sideways nor hops, and tilts little from one frame to the next. Speed and turn
/// stay free.
[[nodiscard]] inline Matrix6d driving_information(double distance_m) {
  const double sigma_side = 0.02 + 0.05 * distance_m;
  constexpr double kSigmaTilt = 0.01;
  Matrix6d information = Matrix6d::Zero();
  const double sigma_up = 2.0 * sigma_side;  // slopes, and the pitch of the camera's mount
  information(1, 1) = 1.0 / (sigma_side * sigma_side);
  information(2, 2) = 1.0 / (sigma_up * sigma_up);
  information(3, 3) = information(4, 4) = 1.0 / (kSigmaTilt * kSigmaTilt);
  return information;
}

}  // namespace roadbook
