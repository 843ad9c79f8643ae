#pragma once

#include <cstdint>
#include <vector>

#include "diagnosis/inference/diagnosis_result.hpp"
#include "diagnosis/streams/noise.hpp"
#include "diagnosis/streams/observations.hpp"

namespace roadbook {

// What the simulation gets wrong: a recorded drive is simulated again along its own reference, once
// as its files state the car and once with the effects found, and the distributions are compared.

/// Draws new readings and poses in place of those of `obs`: a car with `effects` drives the
/// trajectory of `obs` (`trajectory_of_poses`). `noise`: standard deviations of the white parts.
/// Deterministic in `seed`.
[[nodiscard]] Observations simulated_again(const Observations& obs,
                                           const EffectSizes& effects,
                                           const MotionNoise& noise,
                                           std::uint64_t seed);

/// Compares the innovations of each channel (readings less what the lines through the drive's own
/// poses predict with `known`), and the errors of dead reckoning over 5 s, of `obs` with those of
/// four drives simulated with `known`, and of four simulated with `found`. `found` may equal
/// `known`.
[[nodiscard]] std::vector<StreamComparison> compare_with_simulation(const Observations& obs,
                                                                    const EffectSizes& known,
                                                                    const EffectSizes& found,
                                                                    const MotionNoise& noise);

}  // namespace roadbook
