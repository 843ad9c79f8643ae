#pragma once

#include <vector>

#include "diagnosis/map_changes/removed_cells.hpp"

namespace roadbook {

/// One thing that is gone: squares that touch.
struct GoneThing {
  std::vector<std::size_t> landmarks;  ///< of the chances given
  double corrected = 1.0;              ///< probability of its surest square, for all there were
};

struct GoneThingOptions {
  GoneSquareOptions squares;
  /// Share of squares that stand among those named, in the mean; where nothing is gone that is the
  /// probability of naming any.
  double level = 0.005;
  double beside = 0.05;  ///< probability that a named thing is given a square that stands
};

struct GoneThings {
  std::vector<GoneThing> named;  ///< most sure first
  std::size_t tests = 0;         ///< squares with enough landmarks to tell
  double scatter = 0.0;          ///< of what stands, in log odds
};

/// Names squares for themselves (Benjamini and Hochberg 1995): no union of squares is tested, of
/// which there are far too many. Then a square that touches a named one is of the same thing if it
/// is less likely than `beside` over the number of squares that touch one. Chances and scatter are
/// those without all that may have fallen, named or not: what is gone but not sure enough would
/// make what stands seem to scatter, and hide the rest. Deterministic.
[[nodiscard]] GoneThings gone_things(std::vector<LandmarkChance>& chances,
                                     const GoneThingOptions& options = {});

}  // namespace roadbook
