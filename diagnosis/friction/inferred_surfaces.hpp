#pragma once

#include <vector>

#include "diagnosis/friction/friction_readings.hpp"

namespace roadbook {

/// Surfaces where no column says what lay under the wheels: places (cells of 2 m and more) whose
/// mean friction stands in one group, groups at least 0.15 apart. A class for each reading, 0 for
/// the least slippery group. What differs by less is left to the bias of places.
///
/// One-dimensional k-means solved exactly by dynamic programming over the sorted means (Fisher
/// 1958, "On grouping for maximum homogeneity"), number of groups by the Bayesian information
/// criterion.
[[nodiscard]] std::vector<int> inferred_surfaces(const std::vector<FrictionSample>& samples);

}  // namespace roadbook
