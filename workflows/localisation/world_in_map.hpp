#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>

#include "drive/drive.hpp"
#include "mapping/map.hpp"

namespace roadbook {

/// Pose, in the map, of the world in which the truth of `drive` lies: the rigid motion that aligns
/// the true places of the map's poses with the map. It takes all sessions whose simulated drive is
/// available, unchanged, and of the same world. Empty without such a session. Only for evaluation.
/// `map_file` locates the drives.
[[nodiscard]] std::optional<Eigen::Isometry3d> world_in_map(const std::filesystem::path& map_file,
                                                            const Map& map,
                                                            const Drive& drive);

}  // namespace roadbook
