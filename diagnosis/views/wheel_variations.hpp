#pragma once

#include <vector>

#include "diagnosis/inference/candidate.hpp"

namespace roadbook {

/// What the size of a name that the wheels tell might depend on, in the problem of views: terms of
/// kWheelVariations (`Candidate::effect`) that are not the named column itself. None of other
/// names.
[[nodiscard]] std::vector<Candidate> wheel_variations(const Candidate& name);

}  // namespace roadbook
