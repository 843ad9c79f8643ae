#pragma once

#include "sensors/effects.hpp"
#include "sim/scenario/scenario.hpp"

namespace roadbook {

/// Converts the sizes of a model from diagnosis for a simulation of this place. Diagnosis knows
/// only a flat ground: its `ground.hinge` is the whole change of slope. The simulation adds
/// `ground.hinge` to the bend of the place. The function therefore subtracts the bend of the place,
/// and leaves out a size whose remainder is zero. All other sizes stay unchanged.
[[nodiscard]] EffectSizes effects_without_place_hinge(const Scenario& scenario, EffectSizes model);

}  // namespace roadbook
