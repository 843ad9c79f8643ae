#pragma once

#include <algorithm>
#include <cmath>

namespace roadbook {

// The grey level that light gives in an image, without noise. Simulation renders with it and
// diagnosis fits it.

/// Exponent of the grey level as a power of the light: the usual gamma of cameras and screens.
inline constexpr double kGreyPerLight = 1.0 / 2.2;

/// Returns the factor on the light that reaches the sensor. `exposure`: error of the exposure,
/// relative. `vignetting`: light lost at the edge of the image circle, relative. `radius`: distance
/// from the image centre over half the image width.
[[nodiscard]] inline double light_factor(double exposure, double vignetting, double radius) {
  return (1.0 + exposure) * std::max(0.0, 1.0 - vignetting * radius * radius);
}

/// Returns the factor on the grey level for the same arguments.
[[nodiscard]] inline double grey_factor(double exposure, double vignetting, double radius) {
  return std::pow(light_factor(exposure, vignetting, radius), kGreyPerLight);
}

}  // namespace roadbook
