#pragma once

#include <vector>

#include "roadnet/network.hpp"

namespace roadbook {

struct AttractionOptions {
  double step_m = 3.0;  ///< between the positions of the result
  double width_m =
      12.0;              ///< standard deviation of the window in which positions attract each other
  double floor_m = 1.5;  ///< positions farther apart in height belong to different floors
  int rounds = 8;        ///< of mean shift; reduce a noisy street of 60 m to a few metres
};

/// Returns the passes with their positions moved sideways to the densest line of neighbouring
/// positions.
///
/// Satellite positions scatter over a band that is wider than the distance at which a cover
/// separates two roads. The skeleton of such a band has false holes and branches; the skeleton of
/// its middle line has none. Mean shift: a position moves to the weighted mean of the positions
/// around it with about the same line of driving, in either direction (30 degrees). It moves across
/// that line only. Positions are counted in cells of a third of the width, so that the time does
/// not grow with the square of the passes.
///
/// Deterministic, single-threaded, linear in the driven length and the rounds.
[[nodiscard]] std::vector<DrivenPass> attract_passes(const std::vector<DrivenPass>& passes,
                                                     const AttractionOptions& options);

}  // namespace roadbook
