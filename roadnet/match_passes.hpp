#pragma once

#include <vector>

#include "roadnet/network.hpp"
#include "roadnet/way_graph.hpp"

namespace roadbook {

struct MatchedPasses {
  std::vector<DrivenPass> passes;  ///< with the route between their positions filled in
  std::vector<double> offsets_m;   ///< of positions across the lane that they are matched to
};

/// Finds the most probable route of every pass through `graph` (map matching) by a hidden Markov
/// model (Newson and Krumm 2009). The states of a position are the nodes within three standard
/// deviations. Errors of positions are normal; the probability of a route falls exponentially with
/// its cost. The costs of a step are additive, so one search from all states of a position to all
/// states of the next gives the Viterbi values (bounded Dijkstra, whose time does not grow with the
/// size of the graph).
///
/// The result has the shape of the route and passes through the positions themselves; their errors
/// are averaged over passes later. A pass is cut where no route continues. Deterministic,
/// single-threaded.
[[nodiscard]] MatchedPasses match_passes(const std::vector<DrivenPass>& passes,
                                         const WayGraph& graph,
                                         const TrackScales& scales);

}  // namespace roadbook
