#pragma once

#include <vector>

namespace roadbook {

// Share of readings with ten times the scatter, from groups of several readings.

/// What one look is made of.
struct LookShape {
  double freedom = 1.0;   ///< degrees of freedom of its square, where no reading is an outlier
  double readings = 1.0;  ///< that enter it
  /// Of readings as far from a look's ends as each other: their variance in the square, over that
  /// of a degree. At the ends of a line hardly anything of a reading is left.
  std::vector<double> leverages{1.0};
};

/// Groups of readings that are formed in the same way.
struct LooksAlike {
  LookShape shape;
  std::vector<double> squares;  ///< sums, not means
};

struct OutlierShare {
  double share = 0.0;  ///< of readings
  double sigma = 0.0;
};

/// Maximum likelihood estimate: one share for all kinds of groups, with a scale for each kind.
/// Squares are chi-squared; outliers have a hundred times their part. Needs at least one group.
/// Takes some milliseconds a kind.
[[nodiscard]] OutlierShare fit_outlier_share(const std::vector<LooksAlike>& kinds);

}  // namespace roadbook
