#pragma once

#include <string>
#include <vector>

#include "diagnosis/noise_cause.hpp"

namespace roadbook {

// What looks at a stream's scatter tell of its noise.

/// One independent look at a stream's variance: a mean of squares with so many degrees of freedom.
struct ScatterLook {
  double square = 0.0;
  double freedom = 1.0;
  double speed = 0.0;
  double turn = 0.0;
};

/// Of a copy; of an even number the upper one. `values` must not be empty.
[[nodiscard]] double median(std::vector<double> values);
/// Median of chi-squared over its degrees of freedom (Wilson and Hilferty).
[[nodiscard]] double median_share(double freedom);

/// With the two-sided p-value of z.
[[nodiscard]] NoiseCause noise_cause(
    const std::string& effect, const char* unit, double size, double sigma, double z);

/// Regression of log squares on a covariate: a few outliers move a logarithm little. The scatter
/// about the line is measured, not assumed.
[[nodiscard]] NoiseCause variance_by(const std::string& stream,
                                     const char* name,
                                     const char* unit,
                                     const std::vector<ScatterLook>& looks,
                                     double ScatterLook::*covariate);

/// Looks far beyond what their degrees of freedom allow, against how many chance would give.
[[nodiscard]] NoiseCause outliers(const std::string& stream,
                                  const std::vector<ScatterLook>& looks,
                                  double readings_a_look);

}  // namespace roadbook
