#include "roadnet/lane_passes.hpp"

#include <algorithm>
#include <cmath>

#include "roadnet/spatial_hash.hpp"

namespace roadbook {
namespace {

struct Place {
  int lane = -1;  // -1: on a shared point or off the network
  double s = 0.0;
};

struct LaneMeasure {
  double begin_m = 0.0;  // part of the lane where samples belong to it alone
  double end_m = 0.0;
  double length_m = 0.0;
  double most_forward_m = 0.0;
  double most_backward_m = 0.0;
  double square_sum = 0.0;
  int samples = 0;
};

// Distances driven along one lane in one pass.
struct Driven {
  double forward_m = 0.0;
  double backward_m = 0.0;
};

class Ruler {
 public:
  Ruler(const LaneCurves& curves, double reach_m)
      : curves_(curves), radius_m_(1.5 * reach_m), hash_(1.5 * reach_m) {
    place_.resize(curves.points.positions.size());
    lanes.resize(curves.lanes.size());
    for (const Eigen::Vector3d& position : curves.points.positions) hash_.insert(position);
    for (std::size_t l = 0; l < curves.lanes.size(); ++l) measure(l);
  }

  // The place of a sample, and its distance from the network (negative: beyond the search radius).
  Place locate(const Eigen::Vector3d& point, double& distance_m) {
    const int at = hash_.nearest(point, radius_m_);
    distance_m = -1.0;
    if (at < 0) return {};
    const RoadGraph& graph = curves_.points;
    const Eigen::Vector3d& centre = graph.positions[static_cast<std::size_t>(at)];
    double best2 = (point - centre).squaredNorm();
    for (const int other : graph.neighbours[static_cast<std::size_t>(at)]) {
      const Eigen::Vector3d d = graph.positions[static_cast<std::size_t>(other)] - centre;
      const double along = std::clamp((point - centre).dot(d) / d.squaredNorm(), 0.0, 1.0);
      best2 = std::min(best2, (centre + along * d - point).squaredNorm());
    }
    distance_m = std::sqrt(best2);
    const Place place = place_[static_cast<std::size_t>(at)];
    if (place.lane >= 0) {
      lanes[static_cast<std::size_t>(place.lane)].square_sum += best2;
      ++lanes[static_cast<std::size_t>(place.lane)].samples;
    }
    return place;
  }

  std::vector<LaneMeasure> lanes;

 private:
  void measure(std::size_t l) {
    const LaneChain& lane = curves_.lanes[l];
    double s = 0.0;
    for (std::size_t i = 0; i + 1 < lane.nodes.size(); ++i) {
      const bool inner = i > 0 || lane.closed;
      if (inner) place_[static_cast<std::size_t>(lane.nodes[i])] = {static_cast<int>(l), s};
      if (i == 1) lanes[l].begin_m = s;
      if (inner) lanes[l].end_m = s;
      s += (curves_.points.positions[static_cast<std::size_t>(lane.nodes[i + 1])] -
            curves_.points.positions[static_cast<std::size_t>(lane.nodes[i])])
               .norm();
    }
    lanes[l].length_m = s;
    if (lane.closed) lanes[l].begin_m = 0.0;
    if (lane.closed) lanes[l].end_m = s;
  }

  const LaneCurves& curves_;
  double radius_m_;
  SpatialHash hash_;
  std::vector<Place> place_;
};

std::vector<Driven> drive_along(const LaneCurves& curves,
                                const std::vector<Place>& places,
                                const std::vector<LaneMeasure>& lanes) {
  std::vector<Driven> driven(lanes.size());
  Place last;
  for (const Place& place : places) {
    if (place.lane >= 0 && place.lane == last.lane) {
      const auto l = static_cast<std::size_t>(place.lane);
      double ds = place.s - last.s;
      if (std::abs(ds) > 0.5 * lanes[l].length_m) {
        // Across the ends: on a ring the short way round, else left and entered at the other end.
        ds = curves.lanes[l].closed ? ds - std::copysign(lanes[l].length_m, ds) : 0.0;
      }
      (ds > 0.0 ? driven[l].forward_m : driven[l].backward_m) += std::abs(ds);
    }
    if (place.lane >= 0) last = place;
  }
  return driven;
}

}  // namespace

NetworkUse measure_use(const LaneCurves& curves,
                       const std::vector<DrivenPass>& passes,
                       const std::vector<PassSamples>& samples,
                       double reach_m) {
  Ruler ruler(curves, reach_m);
  NetworkUse use;
  use.lanes.resize(curves.lanes.size());
  std::size_t near = 0;
  std::size_t total = 0;
  for (std::size_t p = 0; p < passes.size(); ++p) {
    std::vector<Place> places;
    for (const Eigen::Vector3d& point : samples[p].points) {
      double distance_m = 0.0;
      places.push_back(ruler.locate(point, distance_m));
      near += distance_m >= 0.0 && distance_m <= reach_m ? 1U : 0U;
    }
    total += places.size();
    const std::vector<Driven> driven = drive_along(curves, places, ruler.lanes);
    for (std::size_t l = 0; l < driven.size(); ++l) {
      LaneMeasure& lane = ruler.lanes[l];
      const double span = std::max(lane.end_m - lane.begin_m, 1e-9);
      const int forward = static_cast<int>(std::lround(driven[l].forward_m / span));
      const int backward = static_cast<int>(std::lround(driven[l].backward_m / span));
      if (passes[p].reversing) {
        use.lanes[l].reverse_gear += forward + backward;
        continue;
      }
      use.lanes[l].forward += forward;
      use.lanes[l].backward += backward;
      lane.most_forward_m = std::max(lane.most_forward_m, driven[l].forward_m);
      lane.most_backward_m = std::max(lane.most_backward_m, driven[l].backward_m);
    }
  }
  for (std::size_t l = 0; l < use.lanes.size(); ++l) {
    const LaneMeasure& lane = ruler.lanes[l];
    LaneUse& own = use.lanes[l];
    own.lateral_variance = lane.samples > 0 ? lane.square_sum / lane.samples : 0.0;
    if (own.forward + own.backward + own.reverse_gear > 0) continue;
    (lane.most_forward_m >= lane.most_backward_m ? own.forward : own.backward) = 1;
  }
  use.coverage = total > 0 ? static_cast<double>(near) / static_cast<double>(total) : 0.0;
  return use;
}

}  // namespace roadbook
