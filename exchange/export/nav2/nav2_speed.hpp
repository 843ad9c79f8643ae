#pragma once

#include <vector>

#include "exchange/export/nav2/mask_grid.hpp"
#include "exchange/export/planner/lane_queries.hpp"

namespace roadbook {

/// Speed [m/s] for each cell of a grid, not faster than `query` says at any of its points.
///
/// In the tube of a lane: the least of what the lane's query says in the cell, of all lanes there.
/// Elsewhere: the dynamic map's speed; where that has no place, the least speed of the map. Queries
/// are asked at points at most 0.125 m apart; what may happen between them is bounded by how the
/// gradient changes from one to the next.
///
/// Deterministic for any number of threads (0: all cores).
[[nodiscard]] std::vector<float> cell_speeds(const LaneQueries& queries,
                                             const MaskGrid& grid,
                                             int num_threads = 0);

}  // namespace roadbook
