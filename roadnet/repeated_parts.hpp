#pragma once

#include <vector>

#include "roadnet/network.hpp"

namespace roadbook {

struct RepeatedPartsOptions {
  double step_m = 2.0;    ///< between the positions of the result
  double radius_m = 8.0;  ///< passes within this distance (up to twice of it) are on one road
  int min_passes = 2;     ///< fewer passes are errors of the positions
};

/// Returns the parts of the passes where at least `min_passes` passes, itself included, go by along
/// about the same line in either direction (at most 60 degrees, two radii). Satellite positions
/// jump between tall buildings: wrong positions occur once, roads repeatedly. A pass is cut where
/// positions are left out; the order is kept. Linear in the driven length.
[[nodiscard]] std::vector<DrivenPass> repeated_parts(const std::vector<DrivenPass>& passes,
                                                     const RepeatedPartsOptions& options);

/// Cuts the passes where two positions are farther apart than `max_gap_m`, because the line between
/// them is unknown. 0: does not cut.
[[nodiscard]] std::vector<DrivenPass> cut_at_gaps(const std::vector<DrivenPass>& passes,
                                                  double max_gap_m);

/// Returns the gaps that `cut_at_gaps` removes, each from the last position before it to the first
/// after it.
[[nodiscard]] std::vector<DrivenPass> gaps(const std::vector<DrivenPass>& passes, double max_gap_m);

}  // namespace roadbook
