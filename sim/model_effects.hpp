#pragma once

#include "sensors/effects.hpp"
#include "sim/scenario/scenario.hpp"

namespace roadbook {

/// Sizes of a model that diagnosis has written, as simulation of this place takes them. Diagnosis
/// knows no ground but a flat one: its `ground.hinge` is the whole change of slope, while that of a
/// simulation adds to the bend that the place is built with. What the place has is taken off; a
/// size that nothing is left of is left out. All others stay as they are.
[[nodiscard]] EffectSizes effects_beside_place(const Scenario& scenario, EffectSizes model);

}  // namespace roadbook
