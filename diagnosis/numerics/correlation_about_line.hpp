#pragma once

#include <cstddef>
#include <vector>

namespace roadbook {

// What a process of the first order, AR(1), of unit variance leaves about the line through `count`
// of its readings.

/// For squares about a line through `count` correlated readings, relative to white ones: the share
/// of the degrees of freedom that remains (squared trace over the trace of the square), and a
/// reading's part in a square over that of a degree.
struct CorrelatedFreedom {
  double part = 1.0;
  std::vector<double> leverages;
};

[[nodiscard]] CorrelatedFreedom freedom_of_correlated(double correlation, std::size_t count);

/// Expected sum of squares; count - 2 of white readings.
[[nodiscard]] double square_about_line(double correlation, std::size_t count);

/// Expected lagged products over expected squares.
[[nodiscard]] double ratio_of_correlation(double correlation, std::size_t count);
/// The correlation, 0 to 0.99, that has this ratio.
[[nodiscard]] double correlation_of_ratio(double ratio, std::size_t count);

}  // namespace roadbook
