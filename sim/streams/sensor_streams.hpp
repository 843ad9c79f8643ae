#pragma once

#include <cstdint>
#include <vector>

#include "drive/readings.hpp"
#include "sensors/effects.hpp"
#include "sensors/wheels.hpp"
#include "sim/world/vehicle.hpp"
#include "sim/world/world.hpp"

namespace roadbook {

// Measurements of the sensors other than cameras during a drive.

/// Stamp of the beginning of every simulated drive; revisits follow a day apart.
[[nodiscard]] std::int64_t drive_start_ns(int visit);

struct StreamOptions {
  std::uint64_t seed = 1;
  bool noise = true;
  EffectSizes effects;
};

/// The nominal model that is written to the drive.
[[nodiscard]] WheelModel nominal_wheels(const VehicleSpec& vehicle);

/// Rear wheel angles and steering at 50 Hz.
[[nodiscard]] std::vector<WheelReading> simulate_wheels(const World& world,
                                                        const VehicleMotion& drive,
                                                        std::int64_t start_ns,
                                                        const StreamOptions& options);
/// Angular velocity and specific force at 100 Hz, vehicle frame.
[[nodiscard]] std::vector<ImuReading> simulate_imu(const VehicleMotion& drive,
                                                   std::int64_t start_ns,
                                                   const StreamOptions& options);
/// Class of the ground at (x, y) [m, world frame].
[[nodiscard]] SurfaceClass ground_kind(const World& world, double x, double y);

}  // namespace roadbook
