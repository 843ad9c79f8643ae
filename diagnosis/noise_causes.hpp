#pragma once

#include <vector>

#include "diagnosis/motion_model.hpp"
#include "diagnosis/noise_cause.hpp"

namespace roadbook {

// Causes that are not in what a stream reads but in its noise.

struct NoiseOptions {
  double max_p = 1e-3;  ///< corrected
};

/// Of steering and gyro from the scatter of readings within each window (nothing of the trajectory
/// enters), of poses from the innovations of the final model. Those significant, strongest first.
[[nodiscard]] std::vector<NoiseCause> noise_causes(const Observations& obs,
                                                   const MotionModel& model,
                                                   const NoiseOptions& options = {});

}  // namespace roadbook
