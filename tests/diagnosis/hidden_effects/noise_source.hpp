#pragma once

#include <cmath>
#include <string>

#include "base/random.hpp"
#include "tests/diagnosis/hidden_effects/injector.hpp"
#include "tests/diagnosis/hidden_effects/vehicle.hpp"

namespace roadbook::test {

/// Unit noise of one reading after another; the secret may make it heavy-tailed
/// ("STREAM.outliers": share of readings whose noise is ten times as large), let its variance grow
/// ("STREAM.variance(speed)": log variance per m/s above 2 m/s) or correlate it
/// ("STREAM.correlation": with the reading before).
class NoiseSource {
 public:
  NoiseSource(const HiddenDriveOptions& options, const std::string& stream, std::uint64_t index)
      : random_(options.seed, "noise " + stream, index),
        outliers_(find(options.secret, stream + ".outliers")),
        by_speed_(find(options.secret, stream + ".variance(speed)")),
        by_turn_(find(options.secret, stream + ".variance(turn)")) {
    correlation_ = find(options.secret, stream + ".correlation");
  }

  double next(const Moment& now) {
    const double fresh = random_.normal();
    last_ = started_ ? correlation_ * last_ + std::sqrt(1.0 - correlation_ * correlation_) * fresh
                     : fresh;
    started_ = true;
    double noise = last_;
    if (outliers_ > 0.0 && random_.uniform() < outliers_) noise *= 10.0;
    return noise * growth(now);
  }
  /// Of a standard deviation.
  [[nodiscard]] double growth(const Moment& now) const {
    return std::exp(0.5 * by_speed_ * (std::abs(now.speed) - 2.0) +
                    0.5 * by_turn_ * (std::abs(now.yaw_rate) - 0.2));
  }

 private:
  static double find(const Secret& secret, const std::string& name) {
    const auto found = secret.find(name);
    return found == secret.end() ? 0.0 : found->second;
  }
  Random random_;
  double outliers_ = 0.0, by_speed_ = 0.0, by_turn_ = 0.0, correlation_ = 0.0;
  double last_ = 0.0;
  bool started_ = false;
};

}  // namespace roadbook::test
