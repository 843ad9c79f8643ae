#pragma once

#include <array>
#include <vector>

#include "diagnosis/views/view_data.hpp"

namespace roadbook {

/// Variance inflation of a car's height, roll and pitch by correlation between successive motions.
/// A car rocks on its springs, so the errors of neighbouring motions are correlated. A hinge of the
/// ground takes one wheelbase to cross; its uncertainty follows from sums over a wheelbase, not
/// from single motions.
///
/// `motions`: motions between keyframes, in time order. `wheelbase_m` [m]: length over which
/// residuals are summed. `left[axis][m]`: whitened residual of motion m on an axis (order of
/// Vector6d: x, y, z, roll, pitch, yaw).
///
/// Result: for z, roll and pitch the variance of the sums over that of independent residuals, at
/// least 1; for the other axes 1. Source: Newey and West 1987 (autocorrelation-consistent
/// covariance).
[[nodiscard]] std::array<double, 6> motion_variance_inflation(
    const std::vector<MotionConstraint>& motions,
    double wheelbase_m,
    const std::array<std::vector<double>, 6>& left);

}  // namespace roadbook
