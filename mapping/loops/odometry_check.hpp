#pragma once

#include <cstdint>
#include <vector>

#include "mapping/map.hpp"
#include "vo/keyframe_track.hpp"

namespace roadbook {

/// Finds loops that the odometry contradicts in height, roll and pitch: 1 for each such edge.
///
/// Storeys that look the same give many false loops that agree with each other. Together they
/// outvote the odometry in the pose graph, because its information is discounted for errors that
/// repeat from motion to motion. Over a long way these errors do not repeat in height and tilt.
/// There the discount is taken back, and the covariance of all motions between the two keyframes
/// (to first order) gives the squared Mahalanobis distance of the loop from the odometry. The edges
/// of one number in `stretch` are judged together by their median: all of them contradict beyond
/// the 0.99 quantile of chi-square with 3 degrees of freedom.
///
/// After many passes over a place the odometry's height has drifted. Loops that it contradicts are
/// judged again by the ways over loops that it clearly agrees with, which are shorter: from pass
/// to pass. Storeys that only false loops join have no such way.
///
/// Edges across a gap are not judged. Near linear in keyframes and edges; deterministic.
[[nodiscard]] std::vector<std::uint8_t> contradict_odometry(
    const std::vector<VoKeyframe>& keyframes,
    const std::vector<LoopEdge>& edges,
    const std::vector<int>& stretch);

}  // namespace roadbook
