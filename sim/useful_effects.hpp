#pragma once

#include "sensors/effects.hpp"
#include "sim/scenario.hpp"

namespace roadbook {

/// Effects that would do nothing in a drive of this scenario are refused: a size that is accepted
/// and not applied would be a false truth. Throws BadInput that names each.
void refuse_effects_without_use(const Scenario& scenario, const EffectSizes& effects);

}  // namespace roadbook
