#pragma once

#include <cstdint>
#include <filesystem>

#include "sensors/effects.hpp"
#include "sim/world/moving.hpp"
#include "sim/world/vehicle.hpp"
#include "sim/world/world.hpp"

namespace roadbook {

/// Writes `truth/` of a simulated drive: world.json (scenario, size and seed of the place; spaces,
/// crossings, lanes, walls, pillars, parked cars, shape of the ground), pedestrians.csv,
/// ground_kind.png, effects.json. Nothing but tests and reports reads it. Throws StorageError.
void write_truth_folder(const std::filesystem::path& drive,
                        const World& world,
                        const Pedestrians& people,
                        const VehicleMotion& trajectory,
                        const EffectSizes& effects,
                        std::uint64_t seed,
                        double duration_s);

}  // namespace roadbook
