#pragma once

#include <string>
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

/// Correlation of neighbouring readings whose deviations from a line through `count` of them have
/// the given ratio of lagged products to squares: the inverse of its expectation under AR(1).
[[nodiscard]] double correlation_of_ratio(double ratio, std::size_t count);
/// That expectation.
[[nodiscard]] double ratio_of_correlation(double correlation, std::size_t count);

}  // namespace roadbook
