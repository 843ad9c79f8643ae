#pragma once

#include <vector>

#include "roadnet/network.hpp"
#include "roadnet/network_options.hpp"

namespace roadbook {

struct LineNetwork {
  RoadNetwork network;            ///< without ids; coverage and counts of passes refer to `lines`
  std::vector<DrivenPass> lines;  ///< after `attract_passes`, if the options ask for it
  double max_gap_m = 0.0;  ///< the lines are cut at longer gaps between positions; 0: nowhere
};

struct LineNetworkOptions {
  double reach_m = 3.0;
  double samples_a_reach = 8.0;  ///< samples per reach, so that the cover skips no node
  double share_kept = 1.0;       ///< share of the driven length that the lines hold
  double min_dead_end_m = 0.0;   ///< shorter dead ends are removed, even if positions support them
};

/// Builds the network of passes whose lines are known: their positions are closer together than the
/// reach, or straight lines join them. These are the steps of `build_road_network` from samples and
/// cover to pruning, lanes, centres and counts of passes.
[[nodiscard]] LineNetwork network_of_lines(std::vector<DrivenPass> lines,
                                           const RoadNetworkOptions& options,
                                           const LineNetworkOptions& own,
                                           RoadNetworkStages* stages = nullptr);

/// Length of all lines [m].
[[nodiscard]] double driven_length(const std::vector<DrivenPass>& passes);

}  // namespace roadbook
