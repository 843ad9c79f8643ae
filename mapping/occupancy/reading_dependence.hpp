#pragma once

#include <span>
#include <vector>

#include "mapping/occupancy/scans.hpp"
#include "sensors/range/inverse_range.hpp"

namespace roadbook {

// The grid's filter takes all readings of a cell for independent. They are not: neighbouring scans
// see a cell from nearly the same place, and an edge that covers a part of a cell, or a wide beam,
// has the same error each time. Source: document 001, "Summary II".

struct ReadingDependence {
  std::vector<double> autocorrelation;  ///< of the innovations of a cell, from lag 1
  /// Effective number of many readings over their number, 1 / (1 + 2 sum of the autocorrelation).
  double effective_share = 1.0;
  std::size_t innovations = 0;
};

/// Weight of each of `readings` readings of a cell, (1 + (n - 1) t) / n: the first counts in full,
/// each further one as `temper` (t) of an independent one.
[[nodiscard]] inline double tempered_weight(double readings, double temper) {
  return readings <= 1.0 ? 1.0 : (1.0 + (readings - 1.0) * temper) / readings;
}

/// Estimates the dependence from the scans of a drive. The innovation of a cell is whether a beam
/// that reaches it ends there, minus the probability by the belief of an untempered filter. The
/// autocorrelation is summed up to its first value below 0.02 (at most 60 readings). A sample of
/// an eighth of the cells and at most 3,000 scans is used. Deterministic.
[[nodiscard]] ReadingDependence reading_dependence(std::span<const RangeScan> scans,
                                                   const RangeMixture& mixture,
                                                   const InverseRangeModel& inverse,
                                                   double cell_m,
                                                   double cone_rad);

}  // namespace roadbook
