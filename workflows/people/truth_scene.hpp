#pragma once

#include <filesystem>

#include "mapping/map.hpp"
#include "speedmap/presence/presence_grid.hpp"
#include "workflows/people/detections.hpp"

namespace roadbook {

/// What a simulated drive's truth tells instead of detector and labels: for evaluation, until they
/// exist. People within `range_m` and in sight, 0.1 s apart; walls, pillars and parked cars as
/// blockers; spaces and crossings. Everything is put where the map has it: people relative to the
/// vehicle, the rest by aligning truth and map.
struct TruthScene {
  SessionSightings sightings;
  std::vector<Outline> spaces;
  std::vector<Outline> crossings;
};

/// Walls, pillars, buildings and parked cars of a simulated drive's world, world frame. Throws
/// BadInput where the drive has no `truth/`.
[[nodiscard]] std::vector<SightBlocker> read_world_blockers(const std::filesystem::path& drive);

/// Throws BadInput where the drive has no `truth/` or too few poses in common with the map.
[[nodiscard]] TruthScene read_truth_scene(const Map& map,
                                          int session,
                                          const std::filesystem::path& drive,
                                          double range_m);

}  // namespace roadbook
