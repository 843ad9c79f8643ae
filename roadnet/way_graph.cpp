#include "roadnet/way_graph.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "roadnet/spatial_hash.hpp"

namespace roadbook {
namespace {

constexpr int kSectors = 16;
constexpr double kLanePlaces = 0.5;   // reaches between places on a lane
constexpr double kPlaceRadius = 0.5;  // reaches: positions this near to each other are one place
constexpr double kNeighbours = 12.0;  // reaches
constexpr double kSparseStep = 3.0;   // reaches: a step of this length costs twice its length
constexpr double kOffNetwork = 1.5;   // a metre beside the lanes, once there are lanes
constexpr double kSameEnd_m = 0.001;  // ends of lanes that meet

// Few positions may be errors: one costs twice as much as many.
double doubt(double support) { return 1.0 + 1.0 / std::max(support, 0.5); }

double step_cost(double length_m, double support, const TrackScales& scales) {
  return length_m * (1.0 + length_m / (kSparseStep * scales.reach_m)) * doubt(support);
}

void add_lanes(WayGraph& graph, const RoadNetwork& found, const TrackScales& scales) {
  SpatialHash ends(kSameEnd_m);
  std::vector<int> end_places;
  const auto end_place = [&](const Eigen::Vector3d& position, double passes) {
    const int known = ends.nearest(position, kSameEnd_m);
    if (known >= 0) return end_places[static_cast<std::size_t>(known)];
    ends.insert(position);
    end_places.push_back(graph.add_place(position, passes));
    return end_places.back();
  };
  for (const Lane& lane : found.lanes) {
    const double passes = lane.forward_passes + lane.backward_passes + lane.reverse_gear_passes;
    int last = end_place(lane.centre.front(), passes);
    double since_m = 0.0;
    for (std::size_t i = 1; i < lane.centre.size(); ++i) {
      since_m += (lane.centre[i] - lane.centre[i - 1]).norm();
      const bool is_end = i + 1 == lane.centre.size();
      if (!is_end && since_m < kLanePlaces * scales.reach_m) continue;
      const int place =
          is_end ? end_place(lane.centre[i], passes) : graph.add_place(lane.centre[i], passes);
      double& support = graph.support[static_cast<std::size_t>(place)];
      support = std::max(support, passes);
      graph.add_edge(last, place, since_m * doubt(passes));
      last = place;
      since_m = 0.0;
    }
  }
  graph.lane_places = static_cast<int>(graph.places.size());
}

// Positions that no lane explains become places: the mean of those within half a reach.
void add_positions(WayGraph& graph,
                   const std::vector<DrivenPass>& passes,
                   const TrackScales& scales) {
  SpatialHash lanes(scales.reach_m);
  for (const Eigen::Vector3d& place : graph.places) lanes.insert(place);
  const double radius_m = kPlaceRadius * scales.reach_m;
  SpatialHash seeds(radius_m);
  std::vector<Eigen::Vector3d> sums;
  std::vector<double> counts;
  for (const DrivenPass& pass : passes) {
    for (const Eigen::Vector3d& position : pass.positions) {
      if (lanes.nearest(position, scales.reach_m) >= 0) continue;
      int at = seeds.nearest(position, radius_m);
      if (at < 0) {
        at = static_cast<int>(sums.size());
        seeds.insert(position);
        sums.emplace_back(Eigen::Vector3d::Zero());
        counts.push_back(0.0);
      }
      sums[static_cast<std::size_t>(at)] += position;
      counts[static_cast<std::size_t>(at)] += 1.0;
    }
  }
  for (std::size_t k = 0; k < sums.size(); ++k) graph.add_place(sums[k] / counts[k], counts[k]);
}

void add_neighbour_edges(WayGraph& graph, const TrackScales& scales, double factor) {
  const double radius_m = kNeighbours * scales.reach_m;
  SpatialHash hash(radius_m);
  for (const Eigen::Vector3d& place : graph.places) hash.insert(place);
  struct Nearest {
    int place = -1;
    double d2 = 0.0;
  };
  for (int a = 0; a < static_cast<int>(graph.places.size()); ++a) {
    const Eigen::Vector3d& from = graph.places[static_cast<std::size_t>(a)];
    std::array<Nearest, kSectors> nearest;
    hash.visit_near(from, radius_m, [&](int b, double d2) {
      if (b == a) return;
      const Eigen::Vector3d d = graph.places[static_cast<std::size_t>(b)] - from;
      const double turns = std::atan2(d.y(), d.x()) / (2.0 * std::numbers::pi) + 0.5;
      Nearest& best = nearest[static_cast<std::size_t>(turns * kSectors) % kSectors];
      if (best.place < 0 || d2 < best.d2 || (d2 == best.d2 && b < best.place)) best = {b, d2};
    });
    for (const Nearest& to : nearest) {
      if (to.place < 0) continue;
      const double support = std::min(graph.support[static_cast<std::size_t>(a)],
                                      graph.support[static_cast<std::size_t>(to.place)]);
      graph.add_edge(a, to.place, factor * step_cost(std::sqrt(to.d2), support, scales));
    }
  }
}

// Where nothing else is known, a vehicle went straight on.
void add_straight_edges(WayGraph& graph,
                        const std::vector<DrivenPass>& passes,
                        const TrackScales& scales) {
  SpatialHash hash(scales.reach_m);
  for (const Eigen::Vector3d& place : graph.places) hash.insert(place);
  for (const DrivenPass& pass : passes) {
    int last = -1;
    for (const Eigen::Vector3d& position : pass.positions) {
      const int place = hash.nearest(position, scales.reach_m);
      if (last >= 0 && place >= 0 && place != last) {
        const double length_m = (graph.places[static_cast<std::size_t>(place)] -
                                 graph.places[static_cast<std::size_t>(last)])
                                    .norm();
        if (length_m > kNeighbours * scales.reach_m)
          graph.add_edge(last, place, straight_cost_m(length_m, scales));
      }
      last = place;
    }
  }
}

}  // namespace

int WayGraph::add_place(const Eigen::Vector3d& position, double positions_there) {
  places.push_back(position);
  support.push_back(positions_there);
  edges.emplace_back();
  return static_cast<int>(places.size()) - 1;
}

void WayGraph::add_edge(int a, int b, double cost_m) {
  if (a == b) return;
  edges[static_cast<std::size_t>(a)].push_back({b, cost_m});
  edges[static_cast<std::size_t>(b)].push_back({a, cost_m});
}

double straight_cost_m(double length_m, const TrackScales& scales) {
  return kOffNetwork * step_cost(length_m, 1.0, scales);
}

WayGraph way_graph(const std::vector<DrivenPass>& passes,
                   const RoadNetwork* found,
                   const TrackScales& scales) {
  WayGraph graph;
  if (found != nullptr) add_lanes(graph, *found, scales);
  add_positions(graph, passes, scales);
  add_neighbour_edges(graph, scales, found != nullptr ? kOffNetwork : 1.0);
  add_straight_edges(graph, passes, scales);
  return graph;
}

}  // namespace roadbook
