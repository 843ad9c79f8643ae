#pragma once

#include <vector>

#include "diagnosis/inference/noise_cause.hpp"
#include "diagnosis/motion/motion_model.hpp"
#include "sensors/effects.hpp"

namespace roadbook {

// Causes that are not in what a stream reads but in its noise.

struct NoiseOptions {
  double max_p = 1e-3;  ///< corrected
  EffectSizes known{};  ///< part of the model: sizes found are beyond these
};

/// Noise effects of a drive: of steering and gyro from the scatter of readings within each window
/// (independent of the trajectory), of the wheels from all readings, of poses from the innovations
/// of the final model. Returns the significant ones, strongest first; each is tested with the
/// others of its stream in the model.
[[nodiscard]] std::vector<NoiseCause> noise_causes(const Observations& obs,
                                                   const MotionModel& model,
                                                   const NoiseOptions& options = {});

}  // namespace roadbook
