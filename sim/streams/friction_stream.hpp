#pragma once

#include <cstdint>
#include <vector>

#include "drive/readings.hpp"
#include "sim/streams/sensor_streams.hpp"

namespace roadbook {

/// Friction under the car every `interval_s` (40 Hz) with the class of the ground; `temperature`:
/// also that of the tyres, which warm where they work.
[[nodiscard]] std::vector<FrictionReading> simulate_friction(const World& world,
                                                             const VehicleMotion& drive,
                                                             std::int64_t start_ns,
                                                             const StreamOptions& options,
                                                             bool temperature,
                                                             double interval_s = 0.025);
/// Friction coefficient of what lies on the ground.
[[nodiscard]] double friction_of(SurfaceClass kind);

}  // namespace roadbook
