#pragma once

#include <filesystem>

#include "mapping/map.hpp"
#include "speedmap/presence/presence_grid.hpp"
#include "workflows/people/detections.hpp"

namespace roadbook {

/// The truth of a simulated drive in place of a detector and labels. It serves evaluations that
/// have no detector and labels yet. It has the people within `range_m` and in sight at steps of 0.1
/// s, the spaces and the crossings. Walls, pillars and parked cars are sight blockers. All
/// positions are in the map frame: people through the vehicle pose, other objects through an
/// alignment of truth and map.
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
