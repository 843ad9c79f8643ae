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

/// Walls, pillars, buildings and parked cars of a simulated place as line segments in the map's
/// plane [m], cut at the height of the scanner. Empty unless the last drive is simulated in the
/// world of a session of the map (its `truth/` and that of the session are at hand).
[[nodiscard]] std::optional<Surfaces> true_surfaces(
    const std::filesystem::path& map_file,
    const Map& map,
    const std::vector<std::filesystem::path>& drives);

}  // namespace roadbook
