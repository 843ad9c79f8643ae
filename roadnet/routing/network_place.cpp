#include "roadnet/routing/network_place.hpp"

#include <algorithm>
#include <cmath>

#include "roadnet/floor_height.hpp"

namespace roadbook {

LaneSpot lane_spot(const Lane& lane, double s_m) {
  LaneSpot spot;
  double done = 0.0;
  for (std::size_t i = 0; i + 1 < lane.centre.size(); ++i) {
    const Eigen::Vector3d d = lane.centre[i + 1] - lane.centre[i];
    const double length = d.norm();
    if (length == 0.0) continue;
    const double share = std::clamp((s_m - done) / length, 0.0, 1.0);
    spot.position = lane.centre[i] + share * d;
    spot.direction = d.head<2>().stableNormalized();
    done += length;
    if (s_m <= done) break;
  }
  return spot;
}

std::optional<NetworkPlace> nearest_place(const RoadNetwork& network,
                                          const Eigen::Vector3d& point,
                                          double reach_m) {
  std::optional<NetworkPlace> best;
  double nearest_m = reach_m;
  for (std::size_t l = 0; l < network.lanes.size(); ++l) {
    const auto& line = network.lanes[l].centre;
    double s = 0.0;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const Eigen::Vector3d d = line[i + 1] - line[i];
      const double flat2 = d.head<2>().squaredNorm();
      const double share =
          flat2 > 0.0 ? std::clamp((point - line[i]).head<2>().dot(d.head<2>()) / flat2, 0.0, 1.0)
                      : 0.0;
      const Eigen::Vector3d gap = line[i] + share * d - point;
      const double distance = gap.head<2>().norm();
      const bool floor = std::isnan(point.z()) || std::abs(gap.z()) <= kFloorHeight_m;
      if (floor && (distance < nearest_m || (!best && distance <= nearest_m))) {
        nearest_m = distance;
        best = NetworkPlace{static_cast<int>(l),
                            std::min(s + share * d.norm(), network.lanes[l].length_m), distance};
      }
      s += d.norm();
    }
  }
  return best;
}

}  // namespace roadbook
