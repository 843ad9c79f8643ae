#pragma once

#include <Eigen/Geometry>

#include "base/se3.hpp"
#include "sensors/wheels.hpp"

namespace roadbook {

/// Planar wheel motion as a constraint on SE(3): how well height, roll and pitch stay the same is
/// left to the road.
[[nodiscard]] Matrix6d planar_information(const PlanarMotion& motion);
[[nodiscard]] Eigen::Isometry3d planar_transform(const PlanarMotion& motion);

}  // namespace roadbook
