#pragma once

#include <string>
#include <vector>

#include "diagnosis/motion_model.hpp"

namespace roadbook {

// Causes that are not in what a stream reads but in its noise.

/// "imu0.outliers" (share of readings), "poses.variance(speed)" (change of log variance per m/s),
/// "poses.variance(turn)" (per rad/s), "imu0.correlation" (of neighbouring readings).
struct NoiseCause {
  std::string effect;
  std::string unit;
  double size = 0.0;
  double sigma = 0.0;
  double z = 0.0;  ///< of the null hypothesis, normal under it
  double p = 1.0;  ///< corrected for all noise tests of the drive
};

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
