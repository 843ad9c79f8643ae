#pragma once

#include <Eigen/Core>
#include <vector>

#include "roadnet/network.hpp"

namespace roadbook {

/// Driven positions at even distances, so that slow driving and standstill get no extra weight.
struct PassSamples {
  std::vector<Eigen::Vector3d> points;
};

/// Throws BadInput for positions that are not finite, naming pass and position.
void check_passes(const std::vector<DrivenPass>& passes);

/// Resamples one pass by arc length, `step_m` apart; keeps the first and the last position.
/// `z_scale` multiplies heights. A pass that never moves by a step gives its first position only.
[[nodiscard]] PassSamples resample(const DrivenPass& pass, double step_m, double z_scale = 1.0);

/// Standard deviation [m] of the lateral position of repeated passes on a lane, from the offsets
/// between passes in the same direction. The median makes it robust against passes on other lanes.
/// 0 if nothing was driven twice.
[[nodiscard]] double lateral_scatter(const std::vector<DrivenPass>& passes);

}  // namespace roadbook
