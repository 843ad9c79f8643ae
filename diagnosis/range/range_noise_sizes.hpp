#pragma once

#include <vector>

#include "diagnosis/inference/findings.hpp"
#include "diagnosis/range/range_mixture.hpp"
#include "diagnosis/range/range_readings.hpp"

namespace roadbook {

/// Sizes of the scanner's noise that was found, without what the map takes of them.
///
/// The map is made of the very readings, follows their noise, and errs itself: what is left of a
/// reading beside it shows less of each size. So the hits of the drive are drawn anew with the
/// sizes measured, about the surfaces expected, the map is made of those and the sizes are measured
/// again; by what they came out too small or too large the measured ones are corrected (parametric
/// bootstrap: Efron, Tibshirani, An Introduction to the Bootstrap, 1993, section 10.2), and
/// intervals widen by the error of four such drives and by a quarter of the correction, whose
/// surfaces are themselves of the readings. Sizes that no correction within a factor of
/// two would mend stay as they are, and it is said.
void correct_noise_sizes(const RangeReadings& readings,
                         const RangeMixture& mixture,
                         const RangeParts& parts,
                         std::vector<FoundCause>& causes);

}  // namespace roadbook
