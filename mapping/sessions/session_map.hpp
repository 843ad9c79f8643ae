#pragma once

#include <cstdint>
#include <limits>

#include "mapping/map.hpp"
#include "mapping/pipeline/map_options.hpp"

namespace roadbook {

/// A stretch of time of a session; both ends belong to it.
struct TimeSpan {
  std::int64_t begin_ns = std::numeric_limits<std::int64_t>::min();
  std::int64_t end_ns = std::numeric_limits<std::int64_t>::max();

  [[nodiscard]] bool contains(std::int64_t t_ns) const {
    return begin_ns <= t_ns && t_ns <= end_ns;
  }
};

/// A map of one session of `map`, or of its part within `span`: a drive that was mapped alone.
///
/// Poses and landmarks keep their places in the map (`part_of_map`). Covariances are computed again
/// from the session's own observations and wheels, relative to its first keyframe. Travelled
/// distances begin with 0. What the session saw of landmarks of earlier ones is left out. The same
/// bytes on any number of threads. Throws Refused with fewer keyframes than
/// `MapOptions::min_keyframes` or fewer landmarks than the gate of a build requires.
[[nodiscard]] Map map_of_session(const Map& map,
                                 int session,
                                 const TimeSpan& span,
                                 const MapOptions& options);

}  // namespace roadbook
