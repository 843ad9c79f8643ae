#pragma once

#include <vector>

#include "mapping/joined_tracks.hpp"
#include "mapping/map.hpp"

namespace roadbook {

/// Corners of each image that are kept although no landmark explains them, the strongest ones.
inline constexpr std::size_t kLoneCornersPerImage = 6;

/// The key points that belong to no landmark, at most `kLoneCornersPerImage` an image. `tracks`
/// with a position and `min_views` views or more are landmarks. Keyframes before `first_keyframe`
/// are left out.
[[nodiscard]] std::vector<LoneCorner> lone_corners(const MappingInput& input,
                                                   const std::vector<JoinedTrack>& tracks,
                                                   int min_views,
                                                   std::size_t first_keyframe = 0);

}  // namespace roadbook
