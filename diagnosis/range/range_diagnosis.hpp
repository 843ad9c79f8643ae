#pragma once

#include <string>
#include <vector>

#include "diagnosis/inference/findings.hpp"
#include "diagnosis/range/range_readings.hpp"

namespace roadbook {

/// range0.short, range0.maximum and range0.crosstalk: which shares of the readings are not of the
/// nearest surface. Each is named where the likelihood of the readings, the scatter of one-second
/// blocks and held-out blocks all want it, and where it is more than 0.5 %: less cannot be told
/// from errors of the map that the readings themselves make. A share that is `known` is told even
/// so, with the size that the readings have (`take_off_known` judges it): none tells as much as a
/// large one.
[[nodiscard]] Diagnosis diagnose_ranges(const RangeReadings& readings,
                                        const std::vector<std::string>& without = {},
                                        const EffectSizes& known = {});

/// What the map that the readings themselves make gets wrong in a simulated car park is less.
inline constexpr double kLeastRangeShare = 0.005;

/// What a scanner read in one drive of several.
struct SessionRanges {
  std::string name;
  const RangeReadings* readings = nullptr;
};
/// Several drives: as one where their own shares agree (chi squared, p above 0.001) and the scanner
/// reaches as far; else one by one, marked as of the drive. Of a single one as of the vehicle.
[[nodiscard]] Diagnosis diagnose_ranges(const std::vector<SessionRanges>& drives,
                                        const std::vector<std::string>& without = {});

}  // namespace roadbook
