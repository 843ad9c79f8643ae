#pragma once

#include <string>
#include <vector>

#include "diagnosis/inference/noise_cause.hpp"
#include "diagnosis/numerics/outlier_share.hpp"
#include "sensors/stream_noise.hpp"

namespace roadbook {

// Noise effects of a stream (variance by speed and turn rate, outliers), estimated from independent
// samples of its variance. Each effect is tested with the others in the model.

/// One independent sample of a stream's variance: a mean square with `freedom` degrees of freedom.
struct VarianceSample {
  double square = 0.0;
  double freedom = 1.0;
  double speed = 0.0;
  double turn = 0.0;
  std::size_t kind = 0;  ///< index into the list of shapes
};

/// Median of a chi-squared variable divided by its degrees of freedom (Wilson and Hilferty 1931).
[[nodiscard]] double median_share(double freedom);

/// Noise effect with the two-sided p-value of the normal deviate `z`.
[[nodiscard]] NoiseCause noise_cause(
    const std::string& effect, const char* unit, double size, double sigma, double z);

/// A noise effect beyond this many standard errors is in the model when others of its stream are
/// tested.
inline constexpr double kSureNoise = 4.0;  // [sigma]
[[nodiscard]] inline bool is_sure(const NoiseCause& c) {
  return c.z > kSureNoise || -c.z > kSureNoise;
}

/// Growth of the log variance of a stream with speed [s/m] and turn rate [s/rad], beyond the known
/// part.
struct VarianceSlopes {
  NoiseCause by_speed, by_turn;
  double speed = 0.0,
         turn = 0.0;  ///< slopes of the log variance in total: known and significant parts

  /// The sample, scaled to zero speed and turn rate.
  [[nodiscard]] VarianceSample without(VarianceSample look) const;
};

/// Regression of the log of the samples, which a few outliers hardly change. Speed and turn rate
/// are correlated, so each slope is tested with the other in the model if that is significant. The
/// residual variance is estimated, and the standard error allows for autocorrelated neighbours in
/// `looks`.
[[nodiscard]] VarianceSlopes variance_slopes(const std::string& stream,
                                             const std::vector<VarianceSample>& looks,
                                             const NoiseImperfections& known);

/// Share of outliers. It is significant if more samples are extremely large than expected (Poisson
/// test). The share then comes from `fit_outlier_share`; for samples of single readings, from the
/// number of extreme samples if outliers have 100 times the variance.
///
/// `known`: share that the model contains. If it is above 0, the result is the difference from it.
/// `shapes`: one for each kind of samples.
[[nodiscard]] NoiseCause outliers(const std::string& stream,
                                  const std::vector<VarianceSample>& looks,
                                  const std::vector<LookShape>& shapes,
                                  double known);

/// The same effect with another standard error. `known`: share that the model contains.
[[nodiscard]] NoiseCause with_sigma(const NoiseCause& cause, double sigma, double known);

/// For each sample whether it may contain an outlier; 1 % of the others are as large. The scale
/// comes from the lower quartile of the samples, which outliers hardly change.
[[nodiscard]] std::vector<bool> may_hold_outliers(const std::vector<VarianceSample>& looks);

}  // namespace roadbook
