#pragma once

#include <vector>

#include "diagnosis/map_changes/removed_cells.hpp"

namespace roadbook {

/// A removed region: adjacent cells.
struct RemovedRegion {
  std::vector<std::size_t> landmarks;  ///< indices of landmarks
  double corrected = 1.0;  ///< p-value of its most significant cell, corrected for all cells
};

struct RemovedRegionOptions {
  RemovedCellOptions squares;
  /// False discovery rate of named cells. If nothing was removed, it is the probability of naming
  /// any.
  double level = 0.005;
  double beside = 0.05;  ///< probability that a named region is extended by a present cell
};

struct RemovedRegions {
  std::vector<RemovedRegion> named;  ///< most significant first
  std::size_t tests = 0;             ///< cells with enough landmarks for a test
  double scatter = 0.0;              ///< variation between present cells [log odds]
};

/// Names single cells at a false discovery rate (Benjamini and Hochberg 1995); unions of cells
/// would be far too many to test. A cell that touches a named one joins its region if its p-value
/// is below `beside` over the largest number of touching cells. Probabilities and variation are
/// those without all provisionally removed cells, named or not; otherwise removed cells would widen
/// the variation of present ones and mask the rest. Deterministic.
[[nodiscard]] RemovedRegions removed_regions(std::vector<LandmarkRedetection>& chances,
                                             const RemovedRegionOptions& options = {});

}  // namespace roadbook
