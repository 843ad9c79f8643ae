#pragma once

#include <cstdint>
#include <vector>

namespace roadbook {

// Exposure balance: one gain per image so that images agree on the ground they share.

/// Brightness of a place on the ground as one image has it.
struct ExposureSample {
  std::int64_t place = 0;  ///< any number that names the place
  float log_grey = 0.0F;   ///< natural logarithm of the grey value
};

/// Gains, one per image (1 where an image shares no place with another).
///
/// Model: log grey + log gain = log brightness of the place. Least squares over gains and places,
/// places eliminated, solved by conjugate gradients; residuals beyond 0.1 (10 %) are weighed down
/// (Huber), because glare, shadows and people are no exposure. The gauge is free: gains average 1
/// (geometrically) over all images that share places. Deterministic.
[[nodiscard]] std::vector<double> estimate_gains(
    const std::vector<std::vector<ExposureSample>>& samples_by_image);

}  // namespace roadbook
