#pragma once

#include <vector>

#include "diagnosis/friction/friction_noise.hpp"
#include "diagnosis/inference/innovations.hpp"
#include "diagnosis/inference/noise_cause.hpp"

namespace roadbook {

/// The parts of the noise model as noise effects.
[[nodiscard]] std::vector<NoiseCause> noise_parts(const FrictionNoise& noise);

/// The noise effects friction0.variance(speed) and friction0.variance(turn): slopes of the log
/// variance of the final model's innovations.
[[nodiscard]] std::vector<NoiseCause> variance_causes(const std::vector<FrictionSample>& samples,
                                                      const Innovations& innovations);

}  // namespace roadbook
