#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "mapping/joined_tracks.hpp"

namespace roadbook {

// The key points of a corner that take part in bundle adjustment. Each pass over a place sees the
// same corners again. If all passes shared corners with each other, the time would grow with the
// third power of their number (docs/results/speed.md). So the first passes over a place are its
// base passes, and a corner ties base passes to at most one further pass: the time is linear.

/// Key points of a corner in one pass.
struct CornerPass {
  std::vector<KeyPointId> views;  ///< ascending keyframe, camera
  int nearest = 0;                ///< keyframe with the least distance to the corner
};

/// Splits the views of `track`, which has a position, into passes and keeps the key points of at
/// most `reach_keyframes` keyframes before and after the nearest one of each pass. Ascending.
[[nodiscard]] std::vector<CornerPass> passes_of(const JoinedTrack& track,
                                                const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                                                int reach_keyframes);

/// For each keyframe 1 if it belongs to one of the first `passes` passes over its place: fewer
/// passes of earlier base keyframes lie within 2 m. Deterministic; linear in keyframes.
[[nodiscard]] std::vector<std::uint8_t> find_base_keyframes(
    const std::vector<Eigen::Isometry3d>& T_map_vehicle, int passes);

/// Indices of the passes of a corner at `p_map` that tie it: of the base passes at most `most`, the
/// nearest one first and then those seen from the most different directions. Ascending.
[[nodiscard]] std::vector<std::size_t> choose_base_passes(
    const std::vector<CornerPass>& passes,
    const Eigen::Vector3d& p_map,
    const std::vector<Eigen::Isometry3d>& T_map_vehicle,
    const std::vector<std::uint8_t>& is_base,
    int most);

/// Indices of the passes that are not among `chosen`, those first whose direction from the corner
/// differs most from all of `chosen`.
[[nodiscard]] std::vector<std::size_t> order_further_passes(
    const std::vector<CornerPass>& passes,
    const std::vector<std::size_t>& chosen,
    const Eigen::Vector3d& p_map,
    const std::vector<Eigen::Isometry3d>& T_map_vehicle);

}  // namespace roadbook
