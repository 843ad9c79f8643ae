#pragma once

#include <vector>

#include "roadnet/network.hpp"

namespace roadbook {

/// Driven positions that belong to one lane alone.
struct LaneSamples {
  std::vector<Eigen::Vector3d> points;  ///< [m]
  std::vector<double> share;            ///< of the way along the lane's polyline, 0 to 1
};

/// The positions of all passes, `step_m` apart, given to the nearest lane within `reach_m`; those
/// nearer than `junction_m` along the lane to an intersection are left out, as there vehicles turn
/// off. On short lanes that distance is a third of the lane.
[[nodiscard]] std::vector<LaneSamples> samples_by_lane(const RoadNetwork& network,
                                                       const std::vector<DrivenPass>& passes,
                                                       double step_m,
                                                       double reach_m,
                                                       double junction_m);

}  // namespace roadbook
