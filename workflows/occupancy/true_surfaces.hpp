#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "mapping/map.hpp"
#include "sim/world/world.hpp"

namespace roadbook {

using Surfaces = std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>;

/// The surfaces of a simulated world cut `height_m` above its ground, as line segments, world
/// frame.
[[nodiscard]] Surfaces surfaces_at_height(const World& world, double height_m);

/// Places of people during a simulated drive, world frame; none without
/// `truth/pedestrians.csv`.
[[nodiscard]] std::vector<Eigen::Vector2d> places_walked(const std::filesystem::path& drive);

/// A simulated place in the map's plane [m].
struct TruePlace {
  Surfaces surfaces;                    ///< walls, pillars, buildings and parked cars
  std::vector<Eigen::Vector2d> walked;  ///< places of people during the drive
};

/// The place of the last drive, cut at the height of its scanner, or 0.5 m above the ground for a
/// drive without one. Empty unless the last drive is simulated in the
/// world of a session of the map (its `truth/` and that of the session are at hand).
[[nodiscard]] std::optional<TruePlace> true_place(const std::filesystem::path& map_file,
                                                  const Map& map,
                                                  const std::vector<std::filesystem::path>& drives);

}  // namespace roadbook
