#pragma once

#include <vector>

#include "diagnosis/inference/noise_cause.hpp"
#include "diagnosis/range/range_mixture.hpp"
#include "diagnosis/range/range_readings.hpp"

namespace roadbook {

/// range0.variance(speed), variance(turn) and correlation: how the hits of a scanner scatter about
/// what they should have read, strongest first.
///
/// Each scan's own error of pose (two of place, one of heading) is taken out first: it is common to
/// all beams and goes on from scan to scan, as the noise of a beam does not. Scans of fewer than
/// eight hits tell nothing. Errors from the scatter of one-second blocks. Correlation is that of
/// one beam in neighbouring scans.
[[nodiscard]] std::vector<NoiseCause> range_noise(const RangeReadings& readings,
                                                  const RangeMixture& mixture);

/// The same whether or not any is sure.
[[nodiscard]] std::vector<NoiseCause> measured_range_noise(const RangeReadings& readings,
                                                           const RangeMixture& mixture);

/// Standard deviations of the scans' own errors of pose (x, y [m], heading [rad]), the error that
/// finding them has left out.
[[nodiscard]] Eigen::Vector3d pose_scatter(const RangeReadings& readings,
                                           const RangeMixture& mixture);

}  // namespace roadbook
