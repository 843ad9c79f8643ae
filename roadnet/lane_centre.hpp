#pragma once

#include <vector>

#include "roadnet/graph.hpp"
#include "roadnet/samples.hpp"
#include "roadnet/trace_lanes.hpp"

namespace roadbook {

/// Lanes as dense polylines over shared points: the ends of lanes that meet are one point.
struct LaneCurves {
  RoadGraph points;
  std::vector<LaneChain> lanes;
};

/// The lanes of a skeleton with points about `step_m` apart, at least four inside each lane.
[[nodiscard]] LaneCurves densify(const RoadGraph& skeleton,
                                 const std::vector<LaneChain>& lanes,
                                 double step_m);

/// Moves the points to the middle of the samples on both sides, keeps the line smooth, and
/// lengthens dead ends to the last driven position. Smoothing shifts a curve of radius R to its
/// inside by about 0.2 step^2 / R.
void fit_centres(LaneCurves& curves, const std::vector<PassSamples>& passes, double reach_m);

}  // namespace roadbook
