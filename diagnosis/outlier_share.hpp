#pragma once

#include <vector>

namespace roadbook {

// How many readings scatter ten times as much, from looks of which each holds several readings.

/// What one look is made of.
struct LookShape {
  double freedom = 1.0;   ///< degrees of freedom of its square, where no reading is an outlier
  double readings = 1.0;  ///< that enter it
  /// Of readings as far from a look's ends as each other: their variance in the square, over that
  /// of a degree. At the ends of a line hardly anything of a reading is left.
  std::vector<double> leverages{1.0};
};

struct OutlierShare {
  double share = 0.0;  ///< of readings
  double sigma = 0.0;
  double square = 1.0;  ///< of a degree of freedom, without outliers
};

/// By maximum likelihood: squares are chi-squared, of readings that are outliers with a hundred
/// times their part. `squares`: sums, not means, of at least one look. Some milliseconds.
[[nodiscard]] OutlierShare fit_outlier_share(const std::vector<double>& squares,
                                             const LookShape& shape);

}  // namespace roadbook
