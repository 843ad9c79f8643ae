#pragma once

#include <string>
#include <vector>

#include "diagnosis/streams/streams.hpp"

namespace roadbook {

// Short drives that anybody can make on an empty car park, to tell causes apart.

/// A part of a manoeuvre: speed and curvature go evenly to their aims.
struct ManoeuvreLeg {
  double duration_s = 0.0;
  double speed = 0.0;      ///< at its end [m/s]
  double curvature = 0.0;  ///< at its end [1/m], positive to the left
};

struct Manoeuvre {
  std::string name;  ///< as a person would say it: "a turn of 90 degrees to the left at 2 m/s"
  std::vector<ManoeuvreLeg> legs;
  [[nodiscard]] double duration_s() const;
};

/// From the shortest to the longest.
[[nodiscard]] const std::vector<Manoeuvre>& manoeuvres();

/// What a nominal vehicle's streams show of it, without noise: those streams that `like` has, as
/// often as there.
[[nodiscard]] MotionStreams streams_of(const Manoeuvre& manoeuvre, const MotionStreams& like);

}  // namespace roadbook
