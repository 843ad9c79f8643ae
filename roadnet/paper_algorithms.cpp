#include "roadnet/paper_algorithms.hpp"

#include <cmath>
#include <string>

#include "base/error.hpp"
#include "roadnet/samples.hpp"
#include "roadnet/spatial_hash.hpp"

namespace roadbook {

void LiteralOptions::check() const {
  if (!std::isfinite(connecting_distance_m) || connecting_distance_m <= 0.0) {
    throw InvalidOption("connecting_distance_m", std::to_string(connecting_distance_m),
                        "more than 0");
  }
  if (pruning_loops < 0) {
    throw InvalidOption("pruning_loops", std::to_string(pruning_loops), "0 or more");
  }
}

RoadGraph literal_full_graph(const std::vector<DrivenPass>& passes, double connecting_distance_m) {
  RoadGraph graph;
  SpatialHash hash(connecting_distance_m);
  for (const DrivenPass& pass : passes) {
    for (const Eigen::Vector3d& position : pass.positions) {
      hash.insert(position);
      graph.add_node(position);
    }
  }
  for (int i = 0; i < graph.size(); ++i) {
    hash.visit_near(graph.positions[static_cast<std::size_t>(i)], connecting_distance_m,
                    [&](int j, double) {
                      if (i < j) graph.add_edge(i, j);
                    });
  }
  int begin = 0;
  for (const DrivenPass& pass : passes) {
    const int end = begin + static_cast<int>(pass.positions.size());
    for (int i = begin; i < end; ++i) {
      for (int j = i + 1; j < end && graph.has_edge(i, j); ++j) graph.remove_edge(i, j);
    }
    for (int i = begin; i + 1 < end; ++i) graph.add_edge(i, i + 1);
    begin = end;
  }
  return graph;
}

RoadNetworkStages literal_road_network(const std::vector<DrivenPass>& passes,
                                       const LiteralOptions& options) {
  options.check();
  check_passes(passes);
  RoadNetworkStages stages;
  stages.full = literal_full_graph(passes, options.connecting_distance_m);
  stages.finished = stages.full;
  stages.one_loop = stages.full;
  for (int loop = 0; loop < options.pruning_loops; ++loop) {
    const bool pruned = prune_once(stages.finished, options.spurs, options.clique_limit);
    if (loop == 0) stages.one_loop = stages.finished;
    if (!pruned) break;
  }
  stages.lanes = trace_lanes(stages.finished);
  return stages;
}

}  // namespace roadbook
