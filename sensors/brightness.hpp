#pragma once

#include <algorithm>
#include <cmath>

namespace roadbook {

// How light becomes a grey level, but for noise: what simulation renders with and diagnosis fits.

/// Grey levels grow with this power of the light, as cameras and screens agree on.
inline constexpr double kGreyPerLight = 1.0 / 2.2;

/// Factor on the light by which a camera's exposure is off by `exposure` (relative), and which a
/// lens with `vignetting` (light lost at the image circle's edge, relative) lets through at
/// `radius`, the distance from the image's middle over half its width.
[[nodiscard]] inline double light_factor(double exposure, double vignetting, double radius) {
  return (1.0 + exposure) * std::max(0.0, 1.0 - vignetting * radius * radius);
}

/// Factor on the grey level.
[[nodiscard]] inline double grey_factor(double exposure, double vignetting, double radius) {
  return std::pow(light_factor(exposure, vignetting, radius), kGreyPerLight);
}

}  // namespace roadbook
