#pragma once

#include <cstdint>
#include <functional>

#include "drive/readings.hpp"
#include "sensors/range.hpp"
#include "sim/streams/sensor_streams.hpp"
#include "sim/world/moving.hpp"

namespace roadbook {

/// A scanner that reads all its beams at once, ten times a second: distances to the world's
/// surfaces, moving ones included, until `end_s`. Calls `visit` for each reading, in order.
void simulate_ranges(const World& world,
                     const VehicleMotion& drive,
                     const Pedestrians& people,
                     const RangeModel& model,
                     std::int64_t start_ns,
                     double end_s,
                     const StreamOptions& options,
                     const std::function<void(const RangeReading&)>& visit);

}  // namespace roadbook
