#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/diagnosis/hidden_effects/study_cases.hpp"

namespace roadbook::test {

/// Kinds of noise that one stream can have at once ("imu0.outliers", ...): all sets of two that
/// diagnosis can tell.
[[nodiscard]] std::vector<std::vector<std::string>> noise_pairs();

/// Names of noise that are wrong: found and not hidden, or hidden and not found.
[[nodiscard]] std::size_t wrong_noise(const Outcome& outcome);

/// So many drives of each pair: prints every drive that went
/// wrong, and a line for each pair.
void study_noise_pairs(std::size_t drives, std::uint64_t seed, int threads);

/// So many drives of each share of outliers, of a gyro's correlation beside them, and of its bias
/// beside both: prints what sizes come out.
void study_noise_sizes(std::size_t drives, std::uint64_t seed, int threads);

}  // namespace roadbook::test
