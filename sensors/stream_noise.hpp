#pragma once

#include <string>

#include "base/random.hpp"
#include "sensors/effects.hpp"

namespace roadbook {

/// Sizes of the effects "STREAM.X" of a stream's noise; all zero: white and normal. For wheels, the
/// slip noise along the way grows with speed and turn rate as the noise of the readings does.
struct NoiseImperfections {
  double outliers = 0.0;           ///< share of readings whose noise is ten times as large
  double variance_by_speed = 0.0;  ///< log variance, per m/s of speed above 2 m/s [s/m]
  double variance_by_turn = 0.0;   ///< log variance, per rad/s of turn rate above 0.2 rad/s [s/rad]
  double correlation = 0.0;        ///< with the previous reading
};
/// Reads the sizes for `stream` ("imu0") from `sizes`.
[[nodiscard]] NoiseImperfections noise_imperfections(const EffectSizes& sizes,
                                                     const std::string& stream);

/// Ratio of the noise's standard deviation at `speed` [m/s] and `yaw_rate` [rad/s] to the standard
/// deviation at 2 m/s and 0.2 rad/s.
[[nodiscard]] double noise_growth(const NoiseImperfections& off, double speed, double yaw_rate);

/// Draws the noise of one channel's readings in their order. Without outliers, its standard
/// deviation at 2 m/s and 0.2 rad/s is 1. If all effects are off, each call draws one normal from
/// `random`.
class StreamNoise {
 public:
  StreamNoise(const EffectSizes& sizes, const std::string& stream)
      : off_(noise_imperfections(sizes, stream)) {}
  [[nodiscard]] double next(Random& random, double speed, double yaw_rate);

 private:
  NoiseImperfections off_;
  double last_ = 0.0;
  bool started_ = false;
};

}  // namespace roadbook
