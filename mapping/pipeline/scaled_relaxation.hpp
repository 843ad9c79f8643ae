#pragma once

#include <optional>
#include <vector>

#include "mapping/pipeline/ground.hpp"
#include "mapping/pipeline/map_stages.hpp"

namespace roadbook {

// Scale and pose graph of drives that cameras alone measured. Their odometry has a unit whose
// length drifts along the way. The pose graph therefore estimates a similarity at each keyframe
// (Strasdat, Montiel, Davison 2010), with the cameras' height as a robust prior along the way.

/// Scale of a session without wheels by the height of its cameras.
struct SessionScale {
  std::optional<double> sigma;      ///< relative, of the overall scale; empty: the scale is free
  std::vector<LocalScale> windows;  ///< of the odometry after scaling, along the way
};

/// Multiplies the motions of each stretch of a session without wheels by one factor, so that its
/// unit is a metre in the median. Changes poses, track positions, travelled distances and
/// information. Leaves the session as it is if the height is not known or the ground not seen.
[[nodiscard]] SessionScale scale_session(MappingInput& input,
                                         int session,
                                         const MapOptions& options);

/// As `relax_poses`, with a scale at each keyframe of the sessions without wheels. `heights`:
/// scales by the cameras' height. Loops become metric. Throws as `relax_poses`.
[[nodiscard]] Relaxed relax_scaled_poses(const MappingInput& input,
                                         const std::vector<LocalScale>& heights,
                                         std::vector<LoopClosure>& loops,
                                         const MapOptions& options,
                                         const Progress& progress);

}  // namespace roadbook
