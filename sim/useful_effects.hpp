#pragma once

#include <string>

#include "sensors/effects.hpp"
#include "sim/scenario/scenario.hpp"
#include "sim/simulate_options.hpp"
#include "sim/streams/sensor_streams.hpp"

namespace roadbook {

// Effects that would change nothing in a drive are refused: a size that is accepted and not applied
// would be a false truth. A size of 0 means no effect.

/// Whether any effect's name begins so ("range0.").
[[nodiscard]] bool has_effects_of(const EffectSizes& effects, const std::string& prefix);

/// Refuses effects of sensors that the scenario has not, and those that show in images alone where
/// none are rendered. Throws BadInput that names each.
void refuse_effects_without_use(const Scenario& scenario, const SimulateOptions& options);

/// Refuses effects of wheels, steering, IMU and friction that change no reading until `last_ns`: of
/// a puddle that the route does not meet, of a temperature that does not change. Simulates their
/// stream again for each effect. Throws as above.
void refuse_effects_without_change(const World& world,
                                   const VehicleMotion& drive,
                                   std::int64_t start_ns,
                                   std::int64_t last_ns,
                                   const StreamOptions& streams);

}  // namespace roadbook
