#pragma once

#include <cstddef>
#include <vector>

#include "mapping/loops/loop_closure.hpp"

namespace roadbook {

/// Indices of the accepted loops that enter the pose graph, ascending.
///
/// All of them, up to 2,000. Of more, those between two segments that at most 100 loops join, and
/// from each of about 1,000 groups of successive keyframes one to each segment (`segment` of each
/// keyframe, as of `segments_of`): the one whose earlier keyframe is the latest. After many passes
/// over a place, loops join every pass with every other one, and the factor of the graph's normal
/// equations fills up with the cube of their number; few loops determine the poses nearly as well
/// (docs/results/speed.md). The matches of all loops serve the bundle adjustment.
[[nodiscard]] std::vector<std::size_t> loops_of_graph(const std::vector<LoopClosure>& loops,
                                                      const std::vector<int>& segment);

}  // namespace roadbook
