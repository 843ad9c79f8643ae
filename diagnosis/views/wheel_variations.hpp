#pragma once

#include <vector>

#include "diagnosis/inference/candidate.hpp"

namespace roadbook {

/// Candidates that test whether the size of a wheel effect depends on a covariate, in the problem
/// of views: entries of kWheelVariations (index in `Candidate::effect`) that do not equal the
/// effect's own column. Empty for other effects.
[[nodiscard]] std::vector<Candidate> wheel_variations(const Candidate& name);

}  // namespace roadbook
