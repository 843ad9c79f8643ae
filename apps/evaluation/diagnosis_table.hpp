#pragma once

#include <string>
#include <vector>

#include "apps/evaluation/diagnosis_study.hpp"

namespace roadbook {

/// Returns a study as CSV, one line per drive: the hidden effect, its strength and the diagnosis.
[[nodiscard]] std::string drives_csv(const std::vector<StudiedDrive>& drives);

/// Returns the power of the best possible test for the drive's effect. This test knows which effect
/// to search for. It shares a false alarm rate of one in 200 drives with 24 other tests. The power
/// follows from size over standard error. It is 1 for noise, whose strength the oracle does not
/// know.
[[nodiscard]] double best_power(const StudiedDrive& drive);

/// Returns whether both effects of a pair have a size of at least eight standard errors when both
/// are estimated together. Effects of noise count as strong. An effect that is not observable in
/// the drive's readings does not.
[[nodiscard]] bool is_strong_pair(const StudiedDrive& drive);

}  // namespace roadbook
