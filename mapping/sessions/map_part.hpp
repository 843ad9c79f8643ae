#pragma once

#include <vector>

#include "mapping/map.hpp"

namespace roadbook {

/// The part of a map that the keyframes marked in `keeps` make: they, their sessions, map frames,
/// corners and the loops between them, landmarks that three of their views see, and what these
/// sessions saw of landmarks. Poses and landmarks keep their numbers, bit for bit; they get new
/// indices without gaps. Landmarks that lose views get the covariance that fewer views give.
/// Keyframes that odometry, accepted loops and at least ten common landmarks no longer join become
/// separate pieces.
[[nodiscard]] Map part_of_map(const Map& map, const std::vector<char>& keeps);

}  // namespace roadbook
