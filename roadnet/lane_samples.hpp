#pragma once

#include <vector>

#include "roadnet/network.hpp"

namespace roadbook {

/// Driven positions that belong to one lane only.
struct LaneSamples {
  std::vector<Eigen::Vector3d> points;  ///< [m]
  std::vector<double> share;            ///< position along the lane's polyline, 0 to 1
};

/// Assigns the positions of all passes, `step_m` apart, to the nearest lane within `reach_m`.
/// Positions nearer than `junction_m` along the lane to an intersection are left out, because
/// vehicles turn there. On short lanes this distance is a third of the lane.
[[nodiscard]] std::vector<LaneSamples> samples_by_lane(const RoadNetwork& network,
                                                       const std::vector<DrivenPass>& passes,
                                                       double step_m,
                                                       double reach_m,
                                                       double junction_m);

}  // namespace roadbook
