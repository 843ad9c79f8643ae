#pragma once

#include <vector>

#include "roadnet/network.hpp"

namespace roadbook {

struct RepeatedPartsOptions {
  double step_m = 2.0;    ///< between the positions given back
  double radius_m = 8.0;  ///< passes this near to each other are on one road (to one radius more)
  int min_passes = 2;     ///< fewer passes are errors of the positions
};

/// The parts of the passes where at least `min_passes` passes go by, this one counted, along about
/// the same line in either direction (60 degrees at most, two radii). Satellite positions jump
/// between tall buildings: such places are seen once, roads again and again. A pass is cut where
/// positions are left out; the order is kept. Linear in the driven length.
[[nodiscard]] std::vector<DrivenPass> repeated_parts(const std::vector<DrivenPass>& passes,
                                                     const RepeatedPartsOptions& options);

/// The passes, cut where two positions are farther apart: nobody knows what was driven between. 0:
/// not cut.
[[nodiscard]] std::vector<DrivenPass> cut_at_gaps(const std::vector<DrivenPass>& passes,
                                                  double max_gap_m);

/// What `cut_at_gaps` takes out: from the last position before each gap to the first behind it.
[[nodiscard]] std::vector<DrivenPass> gaps(const std::vector<DrivenPass>& passes, double max_gap_m);

}  // namespace roadbook
