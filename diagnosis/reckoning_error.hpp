#pragma once

#include <optional>
#include <vector>

#include "diagnosis/inference/diagnosis_result.hpp"
#include "diagnosis/streams/observations.hpp"

namespace roadbook {

/// Reckons each piece of `obs` from readings that are freed of `found` beyond `known`: predicted
/// readings and poses with `found`, less those with `known`, both along the reference, are taken
/// off. The reference is averaged over a second at both ends of a piece. Pieces in which the car
/// is at rest, or with a gap of wheels, are left out. Empty without wheels, where only one wheel is
/// read, or with fewer than three pieces.
[[nodiscard]] std::optional<ReckoningError> reckoning_error(const Observations& obs,
                                                            const EffectSizes& known,
                                                            const EffectSizes& found);

/// Distance [m] of the end of each piece from the reference; empty without wheels.
[[nodiscard]] std::vector<double> reckoning_errors_m(const Observations& obs,
                                                     const EffectSizes& known,
                                                     const EffectSizes& found);

/// Adds to `d` the errors with the nominal and with the extended model, and to each effect of
/// motion the error that is left if it alone is not corrected. Nothing without effects of motion.
void add_reckoning(const Observations& obs, const EffectSizes& known, Diagnosis& d);

}  // namespace roadbook
