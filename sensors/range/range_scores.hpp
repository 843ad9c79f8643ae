#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "sensors/range/range_mixture.hpp"

namespace roadbook {

/// Parameters of the beam model. The first are the shares, numbered as `RangePart`.
enum RangeParameter : std::size_t {
  kWideShare = kRangeParts,  ///< `RangeMixture::wide`
  kOutlierWidth,             ///< logarithm of `RangeMixture::outlier`
  kLogSigma,                 ///< logarithm of `RangeMixture::sigma_m`
  kLogRate                   ///< logarithm of `RangeMixture::short_rate_per_m`
};

/// Gradient of the log likelihood, its empirical information (sum of squared scores), and the sum
/// of squared block sums of the scores.
struct RangeScores {
  Eigen::VectorXd gradient;
  Eigen::MatrixXd information;
  Eigen::MatrixXd blocks;

  /// Inverse of the information.
  [[nodiscard]] Eigen::MatrixXd covariance() const;
  /// Covariance for readings that depend on each other within a block (sandwich).
  [[nodiscard]] Eigen::MatrixXd robust_covariance() const;
};

/// The scores of the parameters `which` at a mixture. `densities`: of the samples.
[[nodiscard]] RangeScores range_scores(std::span<const BeamSample> samples,
                                       const std::vector<RangeDensities>& densities,
                                       const std::vector<std::size_t>& which,
                                       double max_m,
                                       double block_s,
                                       const RangeMixture& mixture);

}  // namespace roadbook
