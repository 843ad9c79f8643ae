#pragma once

#include <vector>

#include "diagnosis/friction/friction_sample.hpp"

namespace roadbook {

/// Infers surface classes if no column labels them. Mean frictions of places (cells of 2 m and
/// more) are grouped; groups differ by at least 0.15. Returns a class for each reading, 0 for the
/// group with the highest friction. Smaller differences are left to the spatial bias.
///
/// Method: exact one-dimensional k-means by dynamic programming over the sorted means (Fisher
/// 1958); the number of groups minimises the Bayesian information criterion.
[[nodiscard]] std::vector<int> inferred_surfaces(const std::vector<FrictionSample>& samples);

}  // namespace roadbook
