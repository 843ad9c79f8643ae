#pragma once

#include <vector>

namespace roadbook {

/// What one row adds to a sum, and when.
struct BlockPart {
  double t_s = 0.0;
  double left = 0.0;   ///< the row's part in the error of the sum: residual times weight
  double shown = 0.0;  ///< the row's part in what the sum shows: its information
};

/// Sum over blocks of `length_s` of the squares of what the errors of each block come to. Rows in
/// any order: problems may have one person's after the other's.
[[nodiscard]] double squares_of_blocks(std::vector<BlockPart> parts, double length_s);

/// P-value of a sum by the scatter of blocks of 1, 2, 4, ... s in place of a model's noise: the
/// largest of those lengths that leave six blocks (cluster-robust; F distribution with one
/// degree of freedom less than there are blocks, counted as if each showed as much). Large where
/// errors last. `sum`: over its rows, such that its square over the squares of blocks is a
/// statistic of `freedom` parameters.
[[nodiscard]] double p_by_block_scatter(double sum, std::vector<BlockPart> parts, int freedom);

}  // namespace roadbook
