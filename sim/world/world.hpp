#pragma once

#include <vector>

#include "base/progress.hpp"
#include "sim/world/car_model.hpp"
#include "sim/world/world_content.hpp"

namespace roadbook {

/// Builds the place. A pure function of scenario, effects and moved squares. `progress` is called
/// often and decides whether to continue.
[[nodiscard]] World make_world(const Scenario& scenario,
                               const GroundEffects& effects,
                               int num_threads,
                               const Progress& progress = {},
                               std::vector<MovedPatch> moved = {});

}  // namespace roadbook
