#pragma once

#include <vector>

#include "roadnet/network_of_lines.hpp"

namespace roadbook {

/// Half of the length that was driven lies in longer steps from position to position [m], the
/// longest tenth of the steps left out (they may be gaps); 0 where nothing was driven.
[[nodiscard]] double typical_step(const std::vector<DrivenPass>& passes);

/// Whether nobody knows the line between the positions: satellite tracks (`attraction_m`) whose
/// typical step is longer than three reaches.
[[nodiscard]] bool is_sparse(const std::vector<DrivenPass>& passes,
                             const RoadNetworkOptions& options,
                             double reach_m);

/// The network of tracks whose positions are farther apart than streets.
///
/// In the first round the way between two positions goes over the positions of other passes
/// (`way_graph`), and the network of all ways is built (`network_of_lines`). In every further round
/// the positions are matched along the network found so far, where there is one, and the network is
/// built anew, until it stops changing (four rounds at most). The noise of the positions is
/// measured from how far they lie beside the lanes; the reach is at least 1.2 times as large.
/// Streets driven by at least three passes stay (`min_passes` where it is less), and dead ends
/// longer than four reaches.
///
/// A pass is cut where a step is five times longer than usual. Deterministic, single-threaded.
[[nodiscard]] LineNetwork network_of_sparse_tracks(const std::vector<DrivenPass>& driven,
                                                   const RoadNetworkOptions& options,
                                                   double reach_m,
                                                   RoadNetworkStages* stages = nullptr);

}  // namespace roadbook
