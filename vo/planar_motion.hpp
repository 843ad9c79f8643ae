#pragma once

#include <Eigen/Geometry>

#include "base/se3.hpp"
#include "sensors/wheels.hpp"

namespace roadbook {

/// Returns the information matrix of the planar wheel motion as a constraint on SE(3) (right
/// perturbation). Height, roll and pitch get standard deviations that a road allows.
[[nodiscard]] Matrix6d planar_information(const PlanarMotion& motion);
/// Returns the motion as T_a_b, with height, roll and pitch zero.
[[nodiscard]] Eigen::Isometry3d planar_transform(const PlanarMotion& motion);

}  // namespace roadbook
