#pragma once

#include <vector>

#include "roadnet/network.hpp"

namespace roadbook {

struct RepeatedPartsOptions {
  double step_m = 2.0;     ///< between the positions given back
  double radius_m = 8.0;   ///< passes this near to each other are on one road (to one radius more)
  double max_gap_m = 0.0;  ///< farther between two positions is not driven straight; 0: no limit
  int min_passes = 2;      ///< fewer passes are errors of the positions
};

/// The parts of the passes where at least `min_passes` passes go by, this one counted, along about
/// the same line in either direction (60 degrees at most, two radii). Satellite positions jump
/// between tall buildings: such places are seen once, roads again and again. A pass is cut where
/// positions are left out and at gaps; the order is kept. Linear in the driven length.
[[nodiscard]] std::vector<DrivenPass> repeated_parts(const std::vector<DrivenPass>& passes,
                                                     const RepeatedPartsOptions& options);

}  // namespace roadbook
