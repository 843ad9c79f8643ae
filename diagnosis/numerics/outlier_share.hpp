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

/// Looks that are made alike.
struct LooksAlike {
  LookShape shape;
  std::vector<double> squares;  ///< sums, not means
};

struct OutlierShare {
  double share = 0.0;  ///< of readings
  double sigma = 0.0;
};

/// By maximum likelihood, one share for all kinds of looks, each with a scale of its own: squares
/// are chi-squared, of readings that are outliers with a hundred times their part. At least one
/// look in all. Some milliseconds a kind.
[[nodiscard]] OutlierShare fit_outlier_share(const std::vector<LooksAlike>& kinds);

}  // namespace roadbook
