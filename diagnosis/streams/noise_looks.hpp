#pragma once

#include <string>
#include <vector>

#include "diagnosis/inference/noise_cause.hpp"
#include "diagnosis/numerics/outlier_share.hpp"
#include "sensors/stream_noise.hpp"

namespace roadbook {

// What looks at a stream's scatter tell of its noise, one kind beside the others.

/// One independent look at a stream's variance: a mean of squares with so many degrees of freedom.
struct ScatterLook {
  double square = 0.0;
  double freedom = 1.0;
  double speed = 0.0;
  double turn = 0.0;
  std::size_t kind = 0;  ///< of those with a shape of their own
};

/// Median of chi-squared over its degrees of freedom (Wilson and Hilferty).
[[nodiscard]] double median_share(double freedom);

/// With the two-sided p-value of z.
[[nodiscard]] NoiseCause noise_cause(
    const std::string& effect, const char* unit, double size, double sigma, double z);

/// A kind of noise that shows by more is part of the model when others in its stream are tested.
inline constexpr double kSureNoise = 4.0;  // [sigma]
[[nodiscard]] inline bool is_sure(const NoiseCause& c) {
  return c.z > kSureNoise || -c.z > kSureNoise;
}

/// How the variance of a stream changes with speed and turn, beyond what is known of it.
struct VarianceSlopes {
  NoiseCause by_speed, by_turn;
  double speed = 0.0, turn = 0.0;  ///< of the log variance, in all: what is known and what is sure

  /// The look as it would be at no speed and no turn.
  [[nodiscard]] ScatterLook without(ScatterLook look) const;
};

/// Regression of log squares: a few outliers move a logarithm little. Each of the two is tested
/// beside the other where that is sure. The scatter about the line is measured, not assumed, and
/// neighbours in `looks` may go together.
[[nodiscard]] VarianceSlopes variance_slopes(const std::string& stream,
                                             const std::vector<ScatterLook>& looks,
                                             const NoiseImperfections& known);

/// Looks far beyond what their degrees of freedom allow, against how many chance would give; where
/// these are too many, the share of readings by `fit_outlier_share`, or of single readings by how
/// many of a hundred times the variance are so far. With a share that is known:
/// the share's difference from it. `shapes`: of each kind of looks.
[[nodiscard]] NoiseCause outliers(const std::string& stream,
                                  const std::vector<ScatterLook>& looks,
                                  const std::vector<LookShape>& shapes,
                                  double known);

/// The same size with another error; `known` is what the model has of it.
[[nodiscard]] NoiseCause with_sigma(const NoiseCause& cause, double sigma, double known);

/// Of each look whether an outlier may be in it, where there are some: one in a hundred of the
/// others is as large. By the smaller half of the looks, which outliers enter less.
[[nodiscard]] std::vector<bool> may_hold_outliers(const std::vector<ScatterLook>& looks);

}  // namespace roadbook
