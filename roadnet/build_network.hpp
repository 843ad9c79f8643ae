#pragma once

#include <vector>

#include "roadnet/graph.hpp"
#include "roadnet/network.hpp"
#include "roadnet/trace_lanes.hpp"

namespace roadbook {

// The road network from driven positions [metric-semantic maps, section V-B], in the default mode.
// The driven positions are first thinned to a cover, so that the number of nodes does not grow with
// the number of passes. The cover is pruned until it is a skeleton. All passes of all sessions go
// in at once; pruning session by session loses roads.

struct RoadNetworkOptions {
  double reach_m = 0.0;           ///< cover radius; 0: seven times the lateral scatter found in the
                                  ///< passes, within the two limits below
  double min_reach_m = 3.0;       ///< also used where nothing was driven twice
  double max_reach_m = 4.5;       ///< well under the distance between neighbouring aisles
  double vertical_limit_m = 1.5;  ///< farther apart in height is another floor
  double min_coverage = 0.99;     ///< below this the result is marked kLowCoverage
  int min_passes = 1;             ///< places where fewer passes go by are left out (noisy tracks)
  double max_gap_m = 0.0;         ///< passes are cut where positions are farther apart; 0: nowhere
  double attraction_m = 0.0;  ///< first drawn together over this width (and then covered); 0: not

  /// For tracks of satellite positions a few seconds apart and metres wrong, driven many times
  /// over: streets, not lanes.
  [[nodiscard]] static RoadNetworkOptions for_gps();

  /// Throws InvalidOption, naming the field, its value and the allowed range.
  void check() const;
};

/// The graphs on the way, for pictures like the document's Fig. 8.
struct RoadNetworkStages {
  RoadGraph full;      ///< all nodes with all edges
  RoadGraph one_loop;  ///< after one pruning loop
  RoadGraph finished;
  std::vector<LaneChain> lanes;  ///< of `finished`
};

/// Lanes and intersections of the driven roads. Lanes start at intersections or dead ends, every
/// part of the skeleton is in exactly one lane, and what was driven connected is connected. Centres
/// follow the mean of the driven positions. With `previous`, lanes and intersections that are still
/// there keep their ids; new ids depend on their place alone.
///
/// Passes that never move give an empty network of status kEmpty. Deterministic, single-threaded,
/// about linear in the driven length. Throws InvalidOption, and BadInput for positions that are
/// not finite.
[[nodiscard]] RoadNetwork build_road_network(const std::vector<DrivenPass>& passes,
                                             const RoadNetworkOptions& options = {},
                                             const RoadNetwork* previous = nullptr,
                                             RoadNetworkStages* stages = nullptr);

}  // namespace roadbook
