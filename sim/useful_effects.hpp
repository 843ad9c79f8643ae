#pragma once

#include <string>

#include "sensors/effects.hpp"
#include "sim/scenario/scenario.hpp"
#include "sim/simulate_options.hpp"
#include "sim/streams/sensor_streams.hpp"

namespace roadbook {

// Refuses effects that would change nothing in a drive. Otherwise the truth of the drive would list
// an effect that was not applied. A size of 0 means no effect.

/// Whether the name of any effect begins with `prefix` ("range0.").
[[nodiscard]] bool has_effects_of(const EffectSizes& effects, const std::string& prefix);

/// Refuses effects of sensors that the scenario lacks, and effects that only images show if no
/// images are rendered. Throws BadInput with each of them.
void refuse_effects_without_use(const Scenario& scenario, const SimulateOptions& options);

/// Refuses effects of wheels, steering, IMU and friction that change no reading until `last_ns`,
/// such as those of a puddle that the route does not cross, or of a constant temperature. Simulates
/// the stream again for each effect. Throws as above.
void refuse_effects_without_change(const World& world,
                                   const VehicleMotion& drive,
                                   std::int64_t start_ns,
                                   std::int64_t last_ns,
                                   const StreamOptions& streams);

}  // namespace roadbook
