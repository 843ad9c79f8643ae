#pragma once

#include <string>

namespace roadbook {

/// A cause in the noise, measured after those in the mean: "imu0.outliers" (share of readings),
/// "poses.variance(speed)" (change of log variance per m/s), "poses.variance(turn)" (per rad/s),
/// "imu0.correlation" (of neighbouring readings).
struct NoiseCause {
  std::string effect;
  std::string unit;
  double size = 0.0;
  double sigma = 0.0;
  double z = 0.0;         ///< of the null hypothesis, normal under it
  double p = 1.0;         ///< corrected for all noise tests of the drive
  std::string session{};  ///< of several drives the one that it is of
};

}  // namespace roadbook
