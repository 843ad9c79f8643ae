#pragma once

#include <vector>

#include "diagnosis/inference/findings.hpp"
#include "diagnosis/range/fitted_mixture.hpp"
#include "diagnosis/range/range_readings.hpp"

namespace roadbook {

/// Corrects the sizes of a scanner's noise effects for the map, which is made from the same
/// readings.
///
/// The map follows the noise of the readings and has errors of its own; residuals against it show
/// reduced sizes. Method: hits are simulated with the measured sizes about the expected surfaces, a
/// map is made of them, and the sizes are measured again. The ratio corrects the measured sizes
/// (parametric bootstrap, Efron and Tibshirani 1993, section 10.2). Intervals widen by the standard
/// error of four such simulations and by a quarter of the correction, because the expected surfaces
/// come from the readings. A size that would change by more than a factor of two stays uncorrected,
/// with a note.
void correct_noise_sizes(const RangeReadings& readings,
                         const RangeMixture& mixture,
                         const RangeParts& parts,
                         std::vector<FoundCause>& causes);

}  // namespace roadbook
