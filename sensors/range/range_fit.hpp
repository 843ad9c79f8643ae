#pragma once

#include <span>
#include <vector>

#include "sensors/range/range_mixture.hpp"

namespace roadbook {

// Fits the beam model by expectation maximisation, with standard errors. Source: document 001,
// "Determine model"; Thrun, Burgard and Fox 2005, table 6.2.

struct RangeFitOptions {
  RangeParts parts{};     ///< parts besides the hits; the share of every other part stays 0
  bool wide = true;       ///< whether some hits are wide: errors of map and pose
  double anything = 1e-4; /**< `RangeMixture::anything` */
  /// Starting points (noise and rate of short readings); the fit with the greatest likelihood
  /// counts. 1: the nominal one alone.
  int starts = 1;
  /// Whether the fit continues with steps of Newton's method (BHHH) to the maximum of the
  /// likelihood, and estimates the standard errors of all parameters together. Without it the fit
  /// ends when the shares have settled, and standard errors are those of the shares.
  bool to_the_maximum = false;
  /// Readings within this time depend on each other; standard errors take this into account [s].
  double block_s = 1.0;
};

/// Fits the parameters to readings. Deterministic. Cost: about 100 evaluations of the densities.
[[nodiscard]] RangeMixture fit_range_mixture(std::span<const BeamSample> samples,
                                             double max_m,
                                             const RangeFitOptions& options);

/// Refits the shares alone to the readings marked in `used`, with given densities.
void fit_shares(const std::vector<RangeDensities>& densities,
                const std::vector<bool>& used,
                const RangeParts& parts,
                RangeMixture& mixture);

/// Mean log density of the readings [nats a reading].
[[nodiscard]] double mean_log_density(std::span<const BeamSample> samples,
                                      double max_m,
                                      const RangeMixture& mixture);

}  // namespace roadbook
