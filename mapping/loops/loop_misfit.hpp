#pragma once

#include <Eigen/Geometry>

#include "base/se3.hpp"

namespace roadbook {

/// Misfits above this are contradictions.
inline constexpr double kMostLoopMisfit = 6.0;

/// Distance between a measured motion and the poses, in standard deviations of the motion. 0.1 m
/// and 0.02 rad are added to them, because an adjustment knows more than the two images of a loop.
[[nodiscard]] double loop_misfit(const Eigen::Isometry3d& T_map_from,
                                 const Eigen::Isometry3d& T_map_to,
                                 const Eigen::Isometry3d& T_from_to,
                                 const Matrix6d& information);

}  // namespace roadbook
