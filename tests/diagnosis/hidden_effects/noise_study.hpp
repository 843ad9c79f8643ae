#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/diagnosis/hidden_effects/study_cases.hpp"

namespace roadbook::test {

/// All observable pairs of noise effects of one stream ("imu0.outliers" ...).
[[nodiscard]] std::vector<std::vector<std::string>> noise_pairs();

/// Number of wrong noise effects: found but not hidden, or hidden but not found.
[[nodiscard]] std::size_t wrong_noise(const Outcome& outcome);

/// Runs `drives` of each pair; prints every wrong drive and a line for each pair.
void study_noise_pairs(std::size_t drives, std::uint64_t seed, int threads);

/// Runs `drives` of each share of outliers, of gyro correlation with outliers, and of gyro bias
/// with both; prints the estimated sizes.
void study_noise_sizes(std::size_t drives, std::uint64_t seed, int threads);

}  // namespace roadbook::test
