#pragma once

#include <vector>

#include "diagnosis/inference/noise_cause.hpp"
#include "diagnosis/range/fitted_mixture.hpp"
#include "diagnosis/range/range_readings.hpp"

namespace roadbook {

/// Noise effects range0.variance(speed), range0.variance(turn) and range0.correlation of a
/// scanner's hits, most significant first; only significant ones.
///
/// The pose error of each scan (two for position, one for heading) is projected out first. It is
/// common to all beams and continues from scan to scan, unlike the noise of a beam. Scans with
/// fewer than eight hits are not used. Standard errors come from one-second blocks. The correlation
/// is that of one beam in successive scans.
[[nodiscard]] std::vector<NoiseCause> range_noise(const RangeReadings& readings,
                                                  const RangeMixture& mixture);

/// The same, including effects that are not significant.
[[nodiscard]] std::vector<NoiseCause> measured_range_noise(const RangeReadings& readings,
                                                           const RangeMixture& mixture);

/// Standard deviations of the scans' pose errors (x, y [m], heading [rad]), without their
/// estimation error.
[[nodiscard]] Eigen::Vector3d pose_scatter(const RangeReadings& readings,
                                           const RangeMixture& mixture);

}  // namespace roadbook
