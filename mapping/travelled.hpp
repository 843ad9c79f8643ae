#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "mapping/joined_tracks.hpp"

namespace roadbook {

/// Returns the distance driven since the session's start [m] at each keyframe, along the given
/// poses.
///
/// The distances of odometry have the scale of odometry, which a wrong wheel radius or camera
/// height changes; the distances along the map's poses have the scale of the map. The motion across
/// a gap is unknown and adds nothing. Linear in the number of keyframes.
[[nodiscard]] std::vector<double> travelled_distances(
    const MappingInput& input, const std::vector<Eigen::Isometry3d>& T_map_vehicle);

}  // namespace roadbook
