#pragma once

#include <vector>

#include "roadnet/network.hpp"

namespace roadbook {

struct DrawTogetherOptions {
  double step_m = 3.0;  ///< between the positions of the result
  double width_m =
      12.0;              ///< standard deviation of the window in which positions attract each other
  double floor_m = 1.5;  ///< farther apart in height is another floor
  int rounds = 8;        ///< a noisy street 60 m wide is then a few metres wide
};

/// The passes, their positions moved sideways to where most of their neighbours were driven.
///
/// Satellite positions scatter over a band wider than the distance at which a cover tells two roads
/// apart. A skeleton of the band has holes and fans; of its middle line it has not. Mean shift: a
/// position moves to the weighted mean of the positions around it that were driven along about the
/// same line in either sense (30 degrees), across that line only. Positions are counted in cells of
/// a third of the width, so that the time does not grow with the square of the passes.
///
/// Deterministic, single-threaded, linear in the driven length and the rounds.
[[nodiscard]] std::vector<DrivenPass> draw_together(const std::vector<DrivenPass>& passes,
                                                    const DrawTogetherOptions& options);

}  // namespace roadbook
