#pragma once

#include <cstdint>
#include <vector>

#include "drive/readings.hpp"
#include "sim/streams/sensor_streams.hpp"

namespace roadbook {

/// Simulates the friction under the car every `interval_s` (40 Hz), with the class of the ground.
/// `temperature`: also the temperature of the tyres, which warm up under load.
[[nodiscard]] std::vector<FrictionReading> simulate_friction(const World& world,
                                                             const VehicleMotion& drive,
                                                             std::int64_t start_ns,
                                                             const StreamOptions& options,
                                                             bool temperature,
                                                             double interval_s = 0.025);
/// Friction coefficient of a class of ground.
[[nodiscard]] double friction_of(SurfaceClass kind);

}  // namespace roadbook
