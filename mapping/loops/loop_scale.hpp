#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "mapping/joined_tracks.hpp"
#include "mapping/loops/feature_match.hpp"
#include "mapping/map.hpp"

namespace roadbook {

// Relative scale of the two sides of a loop. Odometry by cameras alone has a scale that drifts, so
// that one unit of it has another length at the two passes.

/// Logarithm of (metres a unit at `to`) / (metres a unit at `from`).
struct LoopScale {
  double log_scale = 0.0;
  double sigma = 0.0;  ///< standard deviation
};

/// Scale from the corners of a loop's matches that both passes triangulated: median over corners of
/// the logarithm of (distance from the later camera by the places of the earlier pass and
/// `edge.T_from_to`) / (the same distance by the places of the later pass). Empty with fewer than 6
/// such corners.
[[nodiscard]] std::optional<LoopScale> scale_of_loop(const Rig& rig,
                                                     const VoResult& odometry,
                                                     const LoopEdge& edge,
                                                     const std::vector<FeatureMatch>& matches);

}  // namespace roadbook
