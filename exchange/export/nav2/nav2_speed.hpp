#pragma once

#include <vector>

#include "exchange/export/nav2/mask_grid.hpp"
#include "exchange/export/planner/lane_queries.hpp"

namespace roadbook {

/// Computes the speed [m/s] for each cell of a grid, nowhere above the result of `query` at a point
/// of the cell. In the tube of a lane it is the least result of the queries of all lanes there.
/// Elsewhere it is the speed of the dynamic map, or the least speed of the map where it has no
/// cell. Queries are made at points at most 0.125 m apart; the change of the gradient between
/// neighbours bounds the speed between them. Deterministic for any number of threads (0: all
/// cores).
[[nodiscard]] std::vector<float> cell_speeds(const LaneQueries& queries,
                                             const MaskGrid& grid,
                                             int num_threads = 0);

}  // namespace roadbook
