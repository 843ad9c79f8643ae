#pragma once

#include <vector>

#include "roadnet/network_of_lines.hpp"

namespace roadbook {

/// Typical distance between two positions [m]: half of the driven length lies in longer steps. The
/// longest tenth of the steps is left out, because they may be gaps. 0 if nothing was driven.
[[nodiscard]] double typical_step(const std::vector<DrivenPass>& passes);

/// Whether the line between the positions is unknown: satellite tracks (`attraction_m` above 0)
/// with a typical step longer than three reaches.
[[nodiscard]] bool is_sparse(const std::vector<DrivenPass>& passes,
                             const RoadNetworkOptions& options,
                             double reach_m);

/// Builds the network of tracks whose positions are farther apart than streets.
///
/// In the first round the route between two positions goes over positions of other passes
/// (`way_graph`), and `network_of_lines` builds the network of all routes. In every further round
/// the positions are matched to the network found so far, and the network is built again, until it
/// stops changing (at most four rounds). The noise of the positions is measured by their distance
/// from the lanes; the reach is at least 1.2 times the noise. Streets with at least three passes
/// stay (`min_passes` if it is less), as do dead ends longer than four reaches.
///
/// A pass is cut where a step is five times longer than usual. Deterministic, single-threaded.
[[nodiscard]] LineNetwork network_of_sparse_tracks(const std::vector<DrivenPass>& driven,
                                                   const RoadNetworkOptions& options,
                                                   double reach_m,
                                                   RoadNetworkStages* stages = nullptr);

}  // namespace roadbook
