#pragma once

#include <vector>

#include "base/error.hpp"
#include "mapping/map.hpp"

namespace roadbook {

/// Contradictions in what joins the poses: pieces that do not follow from odometry, loops and
/// common landmarks; accepted loops and wheels that the poses contradict; landmarks in map frames
/// of another piece.
[[nodiscard]] std::vector<Problem> join_problems(const Map& map);

}  // namespace roadbook
