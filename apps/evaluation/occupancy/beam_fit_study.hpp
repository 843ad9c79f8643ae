#pragma once

#include <cstdint>
#include <vector>

#include "sensors/range/range_fit.hpp"

namespace roadbook {

// The fit of the beam mixture to readings that the simulation's own sensor model drew.

struct BeamFitStudy {
  BeamMixture truth;
  double sigma_m = 0.0;
  double worst_share = 0.0;  ///< greatest error of a share over ten fits to 10,000 beams
  double worst_sigma = 0.0;  ///< greatest relative error of the noise over the same fits
  int draws = 0;             ///< fits whose intervals were counted
  double held_hit = 0.0;     ///< share of 95 % intervals that hold the truth
  double held_short = 0.0;
  double held_maximum = 0.0;
  double held_crosstalk = 0.0;
  double held_sigma = 0.0;
  double held_rate = 0.0;
};

/// Ten fits to 10,000 beams, and `draws` fits to 10,000 beams for the intervals.
[[nodiscard]] BeamFitStudy study_beam_fit(std::uint64_t seed, int draws, int num_threads);

}  // namespace roadbook
