#pragma once

#include "diagnosis/findings.hpp"
#include "diagnosis/range_readings.hpp"

namespace roadbook {

/// range0.short, range0.maximum and range0.crosstalk: which shares of the readings are not of the
/// nearest surface. Each is named where the likelihood of the readings, the scatter of one-second
/// blocks and held-out blocks all want it, and where it is more than 0.5 %: less cannot be told
/// from errors of the map that the readings themselves make.
[[nodiscard]] Diagnosis diagnose_ranges(const RangeReadings& readings,
                                        const std::vector<std::string>& without = {});

}  // namespace roadbook
