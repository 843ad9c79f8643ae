#pragma once

#include <cstddef>
#include <vector>

#include "roadnet/build_network.hpp"
#include "roadnet/prune.hpp"

namespace roadbook {

// Algorithms 1 and 2 of [metric-semantic maps] word for word, for comparison with its figures. The
// guards: pairs i < j (A26), subsequent poses only within a pass (A27), the centre is a member of
// its clique (A28), cliques containing marked nodes are skipped (A29), no edge from a node to
// itself (A30), and algorithm 2 takes edges out instead of nodes (A33-A36).

struct LiteralOptions {
  double connecting_distance_m = 1.0;  ///< d
  int pruning_loops = 20;              ///< P
  SpurRule spurs = SpurRule::kDegreeOne;
  std::size_t clique_limit = 2'000'000;  ///< their number grows exponentially with the passes

  /// Throws InvalidOption, naming the field, its value and the allowed range.
  void check() const;
};

/// Algorithm 1, lines 1-12: poses within `d` joined, except subsequent ones, which are joined in
/// the order they were driven.
[[nodiscard]] RoadGraph literal_full_graph(const std::vector<DrivenPass>& passes,
                                           double connecting_distance_m);

/// The stages of Fig. 8. Stops early when a loop finds no clique. Throws InvalidOption, BadInput
/// for positions that are not finite, and Refused beyond the limit of cliques.
[[nodiscard]] RoadNetworkStages literal_road_network(const std::vector<DrivenPass>& passes,
                                                     const LiteralOptions& options = {});

}  // namespace roadbook
