#pragma once

#include "mapping/optimisation/adjustment_problem.hpp"

namespace roadbook {

/// Throws BadInput that lists (the first of) the indices out of range, values that are not finite
/// and standard deviations that are not positive in `problem`.
void check_bundle(const BundleProblem& problem);

}  // namespace roadbook
