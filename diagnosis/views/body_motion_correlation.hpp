#pragma once

#include <array>
#include <vector>

#include "diagnosis/views/view_data.hpp"

namespace roadbook {

/// How much more the height, roll and pitch of motions vary over a wheelbase than one by one: a car
/// sways on its springs, so that motions side by side go together, and a bend of the ground, which
/// takes a wheelbase to cross, is told from that and not from single motions. `left`: of each axis
/// (as of Vector6d) the whitened residuals of `motions`, in their order. The variance of sums over
/// a wheelbase to that of independent ones, 1 where it is less (Newey and West, A simple, positive
/// semi-definite, heteroskedasticity and autocorrelation consistent covariance matrix, 1987); 1 of
/// the other axes.
[[nodiscard]] std::array<double, 6> sway_ratios(const std::vector<MotionConstraint>& motions,
                                                double wheelbase_m,
                                                const std::array<std::vector<double>, 6>& left);

}  // namespace roadbook
