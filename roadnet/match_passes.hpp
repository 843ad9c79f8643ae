#pragma once

#include <vector>

#include "roadnet/network.hpp"
#include "roadnet/way_graph.hpp"

namespace roadbook {

struct MatchedPasses {
  std::vector<DrivenPass> passes;  ///< with the way between their positions filled in
  std::vector<double> offsets_m;   ///< of positions from the lane they are matched to, across it
};

/// The most probable way of every pass through the places of `graph`: a hidden Markov model (Newson
/// and Krumm 2009) with the places within three standard deviations of a position as its states, a
/// normal error of the positions, and ways that are exponentially less probable with their cost.
/// All costs of a step add up, so one search from all states of a position to all of the next gives
/// the Viterbi values (bounded Dijkstra; its time does not grow with the size of the graph).
///
/// The result runs through the positions themselves across the way: the way has the shape of the
/// road, the positions say where it lies, and their errors are averaged over passes later. A pass
/// is cut where no way leads on. Deterministic, single-threaded.
[[nodiscard]] MatchedPasses match_passes(const std::vector<DrivenPass>& passes,
                                         const WayGraph& graph,
                                         const TrackScales& scales);

}  // namespace roadbook
