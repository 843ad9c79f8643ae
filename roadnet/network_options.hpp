#pragma once

#include <vector>

#include "roadnet/graph.hpp"
#include "roadnet/trace_lanes.hpp"

namespace roadbook {

/// How to find the road network of driven positions.
struct RoadNetworkOptions {
  double reach_m = 0.0;           ///< cover radius; 0: seven times the lateral scatter found in the
                                  ///< passes, within the two limits below
  double min_reach_m = 3.0;       ///< also used if nothing was driven twice
  double max_reach_m = 4.5;       ///< well below the distance between neighbouring aisles
  double vertical_limit_m = 1.5;  ///< positions farther apart in height: different floors
  double min_coverage = 0.99;     ///< below this the result is marked kLowCoverage
  int min_passes = 1;         ///< positions with fewer passes around are left out (noisy tracks)
  double max_gap_m = 0.0;     ///< passes are cut where positions are farther apart; 0: nowhere
  double attraction_m = 0.0;  ///< width of `attract_passes` before the cover; 0: not used

  /// Options for tracks of satellite positions that are seconds apart and metres wrong, with many
  /// passes over each street. The result shows streets, not lanes.
  [[nodiscard]] static RoadNetworkOptions for_gps();

  /// Throws InvalidOption, naming the field, its value and the allowed range.
  void check() const;
};

/// The graphs on the way, for pictures like [metric-semantic maps, Fig. 8].
struct RoadNetworkStages {
  RoadGraph full;      ///< all nodes with all edges
  RoadGraph one_loop;  ///< after one pruning loop
  RoadGraph finished;
  std::vector<LaneChain> lanes;  ///< of `finished`
};

}  // namespace roadbook
