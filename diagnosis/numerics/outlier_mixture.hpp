#pragma once

#include <vector>

namespace roadbook {

/// Residuals as a mixture of N(0, scale^2) and, for a share of them, N(0, (10 scale)^2).
struct OutlierMixture {
  double share = 0.0;
  double share_sigma = 0.0;
  double scale = 1.0;
  double gained = 0.0;       ///< log likelihood over one normal distribution
  double alone = 1.0;        ///< scale of that one
  std::vector<double> part;  ///< of each residual: probability that it is of the wide part
};
/// By expectation and maximisation.
[[nodiscard]] OutlierMixture fit_outliers(const std::vector<double>& residuals);

}  // namespace roadbook
