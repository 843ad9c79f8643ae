#pragma once

#include <vector>

#include "mapping/map.hpp"

namespace roadbook {

/// A landmark of map A and the same one in map B.
struct LandmarkMatch {
  int a = 0;
  int b = 0;
  int keyframe = 0;  ///< of A: the first whose images show both at one place
};

/// Largest distance between two observations of one corner [px].
inline constexpr float kSameCornerPx = 0.5F;

/// Landmarks that both maps saw at the same place of an image. `same`: for each keyframe of A the
/// one of B, -1 where B lacks it. Pairs with the most common observations are matched first, of
/// equal ones those with the lowest ids; a landmark belongs to one match.
[[nodiscard]] std::vector<LandmarkMatch> landmark_matches(const Map& a,
                                                          const Map& b,
                                                          const std::vector<int>& same);

}  // namespace roadbook
