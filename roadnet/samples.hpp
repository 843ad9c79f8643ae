#pragma once

#include <Eigen/Core>
#include <vector>

#include "roadnet/network.hpp"

namespace roadbook {

/// Driven positions at even distances, so that neither speed nor a standstill gives weight.
struct PassSamples {
  std::vector<Eigen::Vector3d> points;
};

/// Throws BadInput for positions that are not finite, naming pass and position.
void check_passes(const std::vector<DrivenPass>& passes);

/// Resamples one pass by arc length, `step_m` apart, first and last position kept. `z_scale`
/// stretches heights. A pass that never moves by a step gives its first position alone.
[[nodiscard]] PassSamples resample(const DrivenPass& pass, double step_m, double z_scale = 1.0);

/// Standard deviation [m] of the lateral position of repeated passes about their lane, from the
/// offsets between passes in the same direction (median: passes on other lanes do not disturb);
/// 0 where nothing was driven twice.
[[nodiscard]] double lateral_scatter(const std::vector<DrivenPass>& passes);

}  // namespace roadbook
