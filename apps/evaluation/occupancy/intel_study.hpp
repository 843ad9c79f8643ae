#pragma once

#include <cstddef>
#include <filesystem>

#include "sensors/range/range_mixture.hpp"

namespace roadbook {

// Recorded scans of an office floor (CARMEN log "Intel lab", 910 scans, 180 beams): the beam model
// of measured readings, and the effect of poses that are wrong.

struct IntelStudy {
  std::size_t scans = 0;
  std::size_t samples = 0;  ///< readings with an expected distance
  RangeMixture fitted;      ///< to all scans
  /// Mean log density of odd scans [nats a beam], shares and noise fitted to the even scans, set by
  /// hand (AMCL's defaults), and of the naive model: hits alone, with the fitted noise.
  double fitted_nats = 0.0;
  double hand_set_nats = 0.0;
  double naive_nats = 0.0;
  /// Thickness of walls [m]: median over cells of 0.5 m of the scatter of beam ends across the
  /// wall, as the width of a uniform strip. Corrected poses, and poses of the odometry.
  double thickness_corrected_m = 0.0;
  double thickness_raw_m = 0.0;
  /// Occupied cells of 0.1 m of the grid, by both poses.
  std::size_t occupied_corrected = 0;
  std::size_t occupied_raw = 0;
};

/// `table`: intel_scans.csv. Throws BadInput for another table. Writes pictures of both grids to
/// `out`.
[[nodiscard]] IntelStudy study_intel(const std::filesystem::path& table,
                                     const std::filesystem::path& out);

}  // namespace roadbook
