#pragma once

#include "diagnosis/streams/observations.hpp"

namespace roadbook {

struct ObservationOptions {
  double step_s = 0.08;  ///< knot interval: 6 Hz of bandwidth, above that of a car's motion
  double max_gap_s = 0.5;
};

/// Cuts all streams to the time span of the poses and reduces them to knot intervals. Headings are
/// unwrapped; over gaps of the poses by dead reckoning. Empty if there are no poses.
[[nodiscard]] Observations observe(const MotionStreams& streams,
                                   const ObservationOptions& options = {});

}  // namespace roadbook
