#pragma once

#include <cstdint>
#include <vector>

namespace roadbook {

// Exposure balance: one gain per image so that images agree on the ground they share.

/// Brightness of a place on the ground as one image has it.
struct ExposureSample {
  std::int64_t place = 0;  ///< any number that names the place
  float log_grey = 0.0F;   ///< natural logarithm of the grey value
  int distance = 0;        ///< class of distances from the camera, from 0
};

struct GainOptions {
  /// Weight of the prior that keeps every gain near 1, as a share of the image's samples. Errors
  /// that go the same way from image to image add up along a drive; the prior stops their sum, and
  /// costs a true step of exposure about this share.
  double prior_share = 0.05;
  double most_gain = 2.0;  ///< gains stay between 1 / most_gain and most_gain

  /// Throws InvalidOption.
  void check() const;
};

/// Gains, one per image (1 where an image shares no place with another).
///
/// Model: log grey + log gain + shade of the distance = log brightness of the place, log gain ~
/// normal around 0 (as the gain compensation of Brown and Lowe 2007, equation 29, in logarithms).
/// The shade is what all images have in common: far ground is seen at a flat angle, and brighter or
/// darker for it. Without this unknown every image of a drive would seem brighter than the one
/// before. Least squares over gains, shades and places, places eliminated, solved by conjugate
/// gradients; residuals beyond 0.1 (10 %) are weighed down (Huber), because glare, shadows and
/// people are no exposure. Deterministic. Throws InvalidOption.
[[nodiscard]] std::vector<double> estimate_gains(
    const std::vector<std::vector<ExposureSample>>& samples_by_image,
    const GainOptions& options = {});

}  // namespace roadbook
