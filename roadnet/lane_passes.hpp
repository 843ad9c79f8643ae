#pragma once

#include <vector>

#include "roadnet/lane_centre.hpp"
#include "roadnet/network.hpp"

namespace roadbook {

/// Statistics of a lane from its passes.
struct LaneUse {
  int forward = 0;   ///< passes first to last
  int backward = 0;  ///< passes last to first
  int reverse_gear = 0;
  double lateral_variance = 0.0;  ///< [m^2]
};

struct NetworkUse {
  std::vector<LaneUse> lanes;
  double coverage = 0.0;  ///< fraction of samples within reach
};

/// Counts the passes over each lane: the distance driven along the lane over its length, rounded. A
/// pass over less than half of a lane does not count, unless no pass covers more. Passes in reverse
/// gear are counted separately, because they do not show the direction of traffic. `samples` belong
/// to `passes`.
[[nodiscard]] NetworkUse measure_use(const LaneCurves& curves,
                                     const std::vector<DrivenPass>& passes,
                                     const std::vector<PassSamples>& samples,
                                     double reach_m);

}  // namespace roadbook
