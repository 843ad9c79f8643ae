#pragma once

#include <cstddef>
#include <string>

#include "mapping/map.hpp"

namespace roadbook {

struct RemovedSession {
  Map map;                         ///< without the session
  std::size_t landmarks_lost = 0;  ///< that fewer than three views of other sessions see
  int pieces_before = 1;
  int pieces = 1;  ///< more than before where nothing but the session joined two places
};

/// Index of the session named `name`. Throws InvalidOption for `option` with the names there are.
[[nodiscard]] int session_named(const Map& map, const std::string& name, const char* option);

/// Takes a session out of a map: its keyframes, its observations and what it saw of landmarks.
/// Poses of the other sessions and landmarks keep their numbers, bit for bit; they get new indices
/// without gaps; landmarks that lose views get the covariance that fewer views give. A map frame
/// goes if no pose is left in it. Keyframes that odometry, accepted loops and at least ten common
/// landmarks no longer join become pieces of their own. Throws Refused for the only session of a
/// map.
[[nodiscard]] RemovedSession without_session(const Map& map, int session);

}  // namespace roadbook
