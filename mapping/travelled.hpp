#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "mapping/joined_tracks.hpp"

namespace roadbook {

/// Distance driven since the session's start [m] at each keyframe, along the poses as they are now.
///
/// Odometry's own distances have its scale (a wheel radius that is wrong, a camera height that was
/// not known yet); those along the map's poses have the map's. The motion across a gap is not known
/// and adds nothing. Linear in the number of keyframes.
[[nodiscard]] std::vector<double> travelled_distances(
    const MappingInput& input, const std::vector<Eigen::Isometry3d>& T_map_vehicle);

}  // namespace roadbook
