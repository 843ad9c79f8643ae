#pragma once

#include <string>
#include <vector>

#include "diagnosis/inference/diagnosis_result.hpp"

namespace roadbook {

/// A section "What the simulation gets wrong": a table of all streams, recorded, simulated as
/// stated and simulated with the effects found, and a quantile plot of each. Empty without
/// comparisons.
[[nodiscard]] std::string simulation_section(const std::vector<StreamComparison>& comparisons);

}  // namespace roadbook
