#pragma once

#include <string>
#include <vector>

#include "diagnosis/streams/streams.hpp"

namespace roadbook {

// Short test drives for an empty car park that separate confounded effects.

/// A part of a manoeuvre. Speed and curvature change linearly to their final values.
struct ManoeuvreLeg {
  double duration_s = 0.0;
  double speed = 0.0;      ///< at its end [m/s]
  double curvature = 0.0;  ///< at its end [1/m], positive to the left
};

struct Manoeuvre {
  std::string name;  ///< for display: "a turn of 90 degrees to the left at 2 m/s"
  std::vector<ManoeuvreLeg> legs;
  [[nodiscard]] double duration_s() const;
};

/// The library of manoeuvres, shortest first.
[[nodiscard]] const std::vector<Manoeuvre>& manoeuvres();

/// The noise-free streams of a nominal vehicle that drives the manoeuvre. They contain the streams
/// that `like` has, at the same rates.
[[nodiscard]] MotionStreams streams_of(const Manoeuvre& manoeuvre, const MotionStreams& like);

}  // namespace roadbook
