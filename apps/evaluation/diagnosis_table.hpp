#pragma once

#include <string>
#include <vector>

#include "apps/evaluation/diagnosis_study.hpp"

namespace roadbook {

/// One line a drive of a study, as CSV: what was hidden, how strongly it shows, what was said.
[[nodiscard]] std::string drives_csv(const std::vector<StudiedDrive>& drives);

/// Probability that the best of all tests names the drive's effect: one that knows which effect to
/// look for and shares a false alarm in 200 drives with 24 others. From size over standard error; 1
/// for noise, whose strength no oracle knows.
[[nodiscard]] double best_power(const StudiedDrive& drive);

/// Returns whether both effects of a pair have a size of at least eight standard errors when both
/// are estimated together. Effects of noise count as strong. An effect that is not observable in
/// the drive's readings does not.
[[nodiscard]] bool is_strong_pair(const StudiedDrive& drive);

}  // namespace roadbook
