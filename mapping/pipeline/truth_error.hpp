#pragma once

#include <optional>
#include <vector>

#include "drive/drive.hpp"
#include "mapping/map.hpp"

namespace roadbook {

/// Distance of the map's poses from the drive's truth after alignment.
struct TruthError {
  double median_m = 0.0;
  double p95_m = 0.0;
};

/// Compares the map of one drive with the drive's truth; also fits the scale if `free_scale`. Empty
/// without truth, and for several drives, because the truth of each has its own frame.
[[nodiscard]] std::optional<TruthError> truth_error(const std::vector<Drive>& drives,
                                                    const Map& map,
                                                    bool free_scale);

}  // namespace roadbook
