#pragma once

#include <Eigen/Core>
#include <vector>

#include "roadnet/network.hpp"

namespace roadbook {

/// Length scales of the search between sparse positions [m].
struct TrackScales {
  double reach_m = 16.0;  ///< two roads closer than this count as one
  double noise_m = 12.0;  ///< standard deviation of a position across its road
};

/// A graph of the positions that a vehicle may have passed between two measured positions, with the
/// cost of each edge. The first `lane_places` nodes lie on the lanes of a network. The other nodes
/// lie where positions off this network accumulate.
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

/// Builds the graph from the positions of all passes and the lanes of the network found so far
/// (nullptr: none yet).
///
/// A metre along a lane costs about a metre. Off the lanes a step of length d costs
/// d (1 + d / (3 reach)). So the cheapest route follows the positions of other passes, which lie on
/// the road, and crosses a block only if no pass went around it (the "Fermat distance" of a sample,
/// whose shortest paths follow its density). Nodes with few positions cost up to twice as much.
/// Every node is joined to its nearest neighbour within 12 reaches in each of 16 directions (a Yao
/// graph). Two successive positions of a pass are joined by a straight step.
///
/// Deterministic; about linear in the number of positions.
[[nodiscard]] WayGraph way_graph(const std::vector<DrivenPass>& passes,
                                 const RoadNetwork* found,
                                 const TrackScales& scales);

/// Cost [m] of a straight step of this length off the lanes, if one position supports it.
[[nodiscard]] double straight_cost_m(double length_m, const TrackScales& scales);

}  // namespace roadbook
