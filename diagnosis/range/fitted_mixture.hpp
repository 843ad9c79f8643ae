#pragma once

#include "diagnosis/range/range_readings.hpp"
#include "sensors/range/range_fit.hpp"

namespace roadbook {

/// The beam model fitted to the readings of a drive. Standard errors of the shares come from blocks
/// of one second. Hits include a uniform density of weight 1e-4 over the whole range, so that the
/// nominal model explains any reading.
[[nodiscard]] RangeMixture fit_mixture(const RangeReadings& readings, const RangeParts& parts);

[[nodiscard]] inline RangeDensities range_densities(const ExpectedRange& reading,
                                                    const RangeMixture& mixture,
                                                    double max_m) {
  return range_densities(reading.read_m, reading.expected_m, mixture, max_m);
}

}  // namespace roadbook
