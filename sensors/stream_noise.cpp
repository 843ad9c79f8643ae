#include "sensors/stream_noise.hpp"

#include <cmath>

namespace roadbook {

NoiseImperfections noise_imperfections(const EffectSizes& sizes, const std::string& stream) {
  const auto size = [&](const char* effect) { return effect_size(sizes, stream, effect); };
  return {size("outliers"), size("variance(speed)"), size("variance(turn)"), size("correlation")};
}

double noise_growth(const NoiseImperfections& off, double speed, double yaw_rate) {
  return std::exp(0.5 * off.variance_by_speed * (std::abs(speed) - 2.0) +
                  0.5 * off.variance_by_turn * (std::abs(yaw_rate) - 0.2));
}

double StreamNoise::next(Random& random, double speed, double yaw_rate) {
  const double fresh = random.normal();
  const double rho = off_.correlation;
  last_ = started_ ? rho * last_ + std::sqrt(1.0 - rho * rho) * fresh : fresh;
  started_ = true;
  const bool off = off_.outliers > 0.0 && random.uniform() < off_.outliers;
  return last_ * noise_growth(off_, speed, yaw_rate) * (off ? 10.0 : 1.0);
}

}  // namespace roadbook
