#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace roadbook {

struct Moments {
  double mean = 0.0;
  double sigma = 0.0;  ///< standard deviation about the mean
};
/// Of one value or more.
[[nodiscard]] Moments moments_of(const std::vector<double>& values);

/// How the second of two samples of one quantity differs from the first.
struct SampleDifference {
  Moments second;  ///< of the second sample
  /// Largest difference of the two distribution functions (Kolmogorov, Smirnov), 0 to 1.
  double distance = 0.0;
  double p = 1.0;  ///< that independent samples differ as much; correlated readings count for less
  /// Quantiles of the first and of the second sample, 1 % to 99 %.
  std::vector<std::pair<double, double>> quantiles;
};

/// Compares two samples, each in the order of time. Both need two values.
[[nodiscard]] SampleDifference compare_samples(const std::vector<double>& first,
                                               const std::vector<double>& second);

}  // namespace roadbook
