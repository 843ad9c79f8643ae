#pragma once

#include <string>
#include <vector>

#include "diagnosis/inference/findings.hpp"
#include "diagnosis/range/range_readings.hpp"

namespace roadbook {

/// Estimates the shares of readings that do not belong to the nearest surface: range0.short,
/// range0.maximum and range0.crosstalk. An effect is reported if the likelihood of the readings,
/// the variation between one-second blocks and held-out blocks all support it, and if its share is
/// above 0.5 %. A smaller share is not separable from errors of the map, which is made from the
/// same readings.
///
/// A share in `known` is always reported with its measured size; `take_off_known` compares both.
/// Zero is then as informative as a large share. `without`: effects that are not searched for.
[[nodiscard]] Diagnosis diagnose_ranges(const RangeReadings& readings,
                                        const std::vector<std::string>& without = {},
                                        const EffectSizes& known = {});

/// Least share: more than the error of the map in a simulated car park.
inline constexpr double kLeastRangeShare = 0.005;

/// Range readings of one of several drives.
struct SessionRanges {
  std::string name;
  const RangeReadings* readings = nullptr;
};
/// Several drives. They are pooled if their shares agree (chi-squared test, p above 0.001) and the
/// maximum range is the same; otherwise each is diagnosed alone and its effects are marked as those
/// of the drive. Effects of a single drive are marked as those of the vehicle.
[[nodiscard]] Diagnosis diagnose_ranges(const std::vector<SessionRanges>& drives,
                                        const std::vector<std::string>& without = {});

}  // namespace roadbook
