#include "sensors/range.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace roadbook {

RangeModel nominal_range_model() {
  RangeModel model;
  constexpr int kBeams = 41;
  constexpr double kStep = 5.0 * std::numbers::pi / 180.0;
  for (int i = 0; i < kBeams; ++i) model.azimuth_rad.push_back((i - kBeams / 2) * kStep);
  model.T_vehicle_sensor.translation() = Eigen::Vector3d(3.5, 0.0, 0.5);
  return model;
}

BeamMixture beam_mixture(const EffectSizes& sizes) {
  BeamMixture mixture;
  mixture.shortened = effect_size(sizes, "range0", "short");
  mixture.maximum = effect_size(sizes, "range0", "maximum");
  mixture.crosstalk = effect_size(sizes, "range0", "crosstalk");
  return mixture;
}

BeamDensity beam_density(
    double read_m, double expected_m, double sigma_m, double short_rate_per_m, double max_m) {
  constexpr double kSame = 1e-9;
  const auto below = [&](double z) {
    return 0.5 * std::erfc(-(z - expected_m) / (sigma_m * std::numbers::sqrt2));
  };
  BeamDensity density;
  if (read_m >= max_m - kSame) {
    density.maximum = 1.0;
    density.hit = expected_m >= max_m - kSame ? 1.0 : 1.0 - below(max_m);
    return density;
  }
  if (read_m < 0.0) return density;
  density.crosstalk = 1.0 / max_m;
  if (expected_m < max_m - kSame) {
    const double u = (read_m - expected_m) / sigma_m;
    density.hit = std::exp(-0.5 * u * u) / (sigma_m * std::sqrt(2.0 * std::numbers::pi));
  }
  if (read_m <= expected_m && expected_m > 0.0)
    density.shortened = short_rate_per_m * std::exp(-short_rate_per_m * read_m) /
                        -std::expm1(-short_rate_per_m * expected_m);
  return density;
}

double predict_range(const RangeModel& model,
                     const BeamMixture& mixture,
                     double expected_m,
                     double part,
                     double within,
                     double normal) {
  if (part < mixture.maximum) return model.max_m;
  part -= mixture.maximum;
  if (part < mixture.crosstalk) return within * model.max_m;
  part -= mixture.crosstalk;
  if (part < mixture.shortened) {
    // Inverse of the truncated exponential's distribution.
    const double all = -std::expm1(-mixture.short_rate_per_m * expected_m);
    return -std::log1p(-within * all) / mixture.short_rate_per_m;
  }
  if (expected_m >= model.max_m) return model.max_m;
  return std::clamp(expected_m + model.sigma_m * normal, 0.0, model.max_m);
}

}  // namespace roadbook
