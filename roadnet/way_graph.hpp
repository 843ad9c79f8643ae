#pragma once

#include <Eigen/Core>
#include <vector>

#include "roadnet/network.hpp"

namespace roadbook {

/// Lengths that the search between sparse positions is measured in [m].
struct TrackScales {
  double reach_m = 16.0;  ///< two roads closer than that are one
  double noise_m = 12.0;  ///< standard deviation of a position across its road
};

/// Where a vehicle may have been between two of its positions: places, and what a way from place to
/// place costs. The first `lane_places` places lie on the lanes of a network, the others where
/// positions off this network accumulate.
struct WayGraph {
  struct Edge {
    int to = -1;
    double cost_m = 0.0;
  };
  std::vector<Eigen::Vector3d> places;
  std::vector<double> support;  ///< positions at a place; passes over the lane of a lane place
  std::vector<std::vector<Edge>> edges;  ///< symmetric
  int lane_places = 0;

  int add_place(const Eigen::Vector3d& position, double positions_there);
  void add_edge(int a, int b, double cost_m);
};

/// The ways that the positions of all passes suggest, and the lanes of the network found so far
/// (nullptr: none yet).
///
/// A metre along a lane costs about a metre. Off the lanes a step of length d costs
/// d (1 + d / (3 reach)): the cheapest way goes from position to position of other passes, which
/// lie on the road, and turns with it; it cuts through a block only where nobody was seen (the
/// "Fermat distance" of a sample, whose shortest paths follow its density). Places with few
/// positions cost up to twice as much. Every place is joined to its nearest neighbour within 12
/// reaches in each of 16 directions (a Yao graph), and two positions that follow each other by a
/// straight step.
///
/// Deterministic; about linear in the number of positions.
[[nodiscard]] WayGraph way_graph(const std::vector<DrivenPass>& passes,
                                 const RoadNetwork* found,
                                 const TrackScales& scales);

/// What a straight step of that length costs off the lanes, where one position supports it [m].
[[nodiscard]] double straight_cost_m(double length_m, const TrackScales& scales);

}  // namespace roadbook
