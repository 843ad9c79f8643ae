#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "drive/drive.hpp"
#include "mapping/map.hpp"

namespace roadbook {

// The checks of `roadbook check MAP --deep`: whether the numbers of a map agree with each other.
// `map_problems` (mapping/store/map_check.hpp) checks that they can be read at all.

/// Contradictions between poses, landmarks, cameras, wheels, loops, pieces and covariances of a
/// map that has passed `map_problems`. One line for each kind and session. Linear in the size of
/// the map.
[[nodiscard]] std::vector<Problem> deep_map_problems(const Map& map);

/// Landmarks whose descriptor is unlike those of all their key points in the recordings. `drives`:
/// the recordings by session; null: missing. Landmarks with a view of a session whose recording is
/// missing are not judged. Reads the images of all keyframes.
[[nodiscard]] std::vector<Problem> descriptor_problems(const Map& map,
                                                       const std::vector<const Drive*>& drives,
                                                       int num_threads = 0);

}  // namespace roadbook
