#pragma once

#include <cstddef>
#include <vector>

#include "roadnet/build_network.hpp"
#include "roadnet/prune.hpp"

namespace roadbook {

// Algorithms 1 and 2 of [metric-semantic maps] word for word, for comparison with its figures. The
// guards: pairs i < j, subsequent poses only within a pass, the centre is a member of
// its clique, cliques containing marked nodes are skipped, no edge from a node to
// itself, and algorithm 2 takes edges out instead of nodes.

struct LiteralOptions {
  double connecting_distance_m = 1.0;  ///< d
  int pruning_loops = 20;              ///< P
  SpurRule spurs = SpurRule::kDegreeOne;
  std::size_t clique_limit = 2'000'000;  ///< their number grows exponentially with the passes

  /// Throws InvalidOption, naming the field, its value and the allowed range.
  void check() const;
};

/// Algorithm 1, lines 1-12: joins poses within `connecting_distance_m`. Subsequent poses of a pass
/// are joined in driving order instead.
[[nodiscard]] RoadGraph literal_full_graph(const std::vector<DrivenPass>& passes,
                                           double connecting_distance_m);

/// Returns the stages of figure 8. Stops early if a pruning loop finds no clique. Throws
/// InvalidOption, BadInput for positions that are not finite, and Refused beyond the limit of
/// cliques.
[[nodiscard]] RoadNetworkStages literal_road_network(const std::vector<DrivenPass>& passes,
                                                     const LiteralOptions& options = {});

}  // namespace roadbook
