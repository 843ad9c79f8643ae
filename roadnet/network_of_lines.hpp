#pragma once

#include <vector>

#include "roadnet/network.hpp"
#include "roadnet/network_options.hpp"

namespace roadbook {

struct LineNetwork {
  RoadNetwork network;            ///< without names; coverage and use are those of `lines`
  std::vector<DrivenPass> lines;  ///< drawn together, where the options say so
  double max_gap_m = 0.0;  ///< the lines are cut at longer gaps between positions; 0: nowhere
};

struct LineNetworkOptions {
  double reach_m = 3.0;
  double samples_a_reach = 8.0;  ///< the cover must not skip a place between two samples
  double share_kept = 1.0;       ///< of what was driven that is in the lines
  double min_dead_end_m = 0.0;   ///< shorter dead ends go, even where positions lie beside the rest
};

/// The network of passes whose lines are known: their positions are closer together than the reach,
/// or straight lines join them. Samples, cover, pruning, lanes, centres and use of
/// `build_road_network`.
[[nodiscard]] LineNetwork network_of_lines(std::vector<DrivenPass> lines,
                                           const RoadNetworkOptions& options,
                                           const LineNetworkOptions& own,
                                           RoadNetworkStages* stages = nullptr);

/// Length of all lines [m].
[[nodiscard]] double driven_length(const std::vector<DrivenPass>& passes);

}  // namespace roadbook
