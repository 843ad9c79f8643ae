#pragma once

#include <vector>

namespace roadbook {

/// Standard deviation of the white noise in successive values of a smooth quantity, from their
/// third differences: the median of their sizes, which single jumps do not change. 0 with fewer
/// than four values.
[[nodiscard]] double white_scatter(const std::vector<double>& values);

}  // namespace roadbook
