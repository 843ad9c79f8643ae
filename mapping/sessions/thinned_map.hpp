#pragma once

#include <cstddef>
#include <vector>

#include "mapping/map.hpp"

namespace roadbook {

/// A map with fewer keyframes.
struct ThinnedMap {
  Map map;               ///< without corners
  std::vector<int> now;  ///< of each keyframe of the whole map: the last one kept up to it
};

/// Keeps the first keyframe of each session and piece, those after a gap, and from there every
/// `step`-th. Wheels' motions are joined, and loops get the keyframes that stay. Observations of
/// the others go; landmarks and map frames stay.
[[nodiscard]] ThinnedMap thinned_map(const Map& map, std::size_t step);

}  // namespace roadbook
