#pragma once

#include <string>

#include "base/random.hpp"
#include "sensors/effects.hpp"

namespace roadbook {

/// Sizes of the effects "STREAM.X" that concern a stream's noise; all zero: white and normal.
/// What wheels scatter on their way grows with speed and turn as their readings' noise does.
struct NoiseImperfections {
  double outliers = 0.0;           ///< share of readings whose noise is ten times as large
  double variance_by_speed = 0.0;  ///< of the log variance, per m/s above 2 m/s [s/m]
  double variance_by_turn = 0.0;   ///< the same per rad/s of turn rate above 0.2 rad/s [s/rad]
  double correlation = 0.0;        ///< with the reading before
};
[[nodiscard]] NoiseImperfections noise_imperfections(const EffectSizes& sizes,
                                                     const std::string& stream);

/// Standard deviation of noise over that at 2 m/s and 0.2 rad/s.
[[nodiscard]] double noise_growth(const NoiseImperfections& off, double speed, double yaw_rate);

/// Noise of one channel's readings, one after another, of unit standard deviation at 2 m/s and
/// 0.2 rad/s without outliers. With nothing off, each draws one normal from `random`.
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
