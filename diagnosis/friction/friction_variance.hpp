#pragma once

#include <vector>

#include "diagnosis/friction/friction_noise.hpp"
#include "diagnosis/inference/innovations.hpp"
#include "diagnosis/inference/noise_cause.hpp"

namespace roadbook {

/// The parts of the noise that were taken in, as causes.
[[nodiscard]] std::vector<NoiseCause> noise_parts(const FrictionNoise& noise);

/// friction0.variance(speed) and variance(turn) from white innovations of the final model: the
/// logarithm of their variance as a line in the covariate.
[[nodiscard]] std::vector<NoiseCause> variance_causes(const std::vector<FrictionSample>& samples,
                                                      const Innovations& innovations);

}  // namespace roadbook
