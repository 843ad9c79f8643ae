#pragma once

#include <cstdint>
#include <vector>

namespace roadbook {

// Exposure balance: one gain per image, so that images agree on the ground they share.

/// Grey value of one image at one ground cell.
struct ExposureSample {
  std::int64_t place = 0;  ///< identifies the ground cell; any number
  float log_grey = 0.0F;   ///< natural logarithm of the grey value
  int distance = 0;        ///< index of the distance class, from 0 at the camera
};

struct GainOptions {
  /// Weight of the prior that keeps every gain near 1, as a share of the image's samples. The prior
  /// limits the drift that small errors between successive images cause along a drive. It also
  /// attenuates a true step of exposure by about this share.
  double prior_share = 0.05;
  double most_gain = 2.0;  ///< gains stay between 1 / most_gain and most_gain

  /// Throws InvalidOption.
  void check() const;
};

/// Estimates one gain per image; 1 for an image that shares no ground cell with another.
///
/// Model: log grey + log gain + shade(distance) = log brightness of the cell, with log gain ~
/// normal around 0 (gain compensation of Brown and Lowe 2007, equation 29, in logarithms). The
/// shade is common to all images: distant ground is seen at a flat angle and looks brighter or
/// darker. Without it, the gains would drift along a drive. Solved by least squares over gains,
/// shades and cells: cells are eliminated, the rest is solved by conjugate gradients. Huber weights
/// beyond 0.1 (10 %) limit the effect of glare, shadows and people. Deterministic. Throws
/// InvalidOption.
[[nodiscard]] std::vector<double> estimate_gains(
    const std::vector<std::vector<ExposureSample>>& samples_by_image,
    const GainOptions& options = {});

}  // namespace roadbook
