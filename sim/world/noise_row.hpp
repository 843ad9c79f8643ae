#pragma once

#include <deque>
#include <vector>

#include "sim/world/noise.hpp"
#include "sim/world/paint.hpp"

namespace roadbook {

/// Noises of several sizes along one row of a canvas. The returned values live as long as this
/// object.
class NoiseRow {
 public:
  /// `y_m`: position of the row.
  NoiseRow(const Canvas& canvas, float y_m);

  /// fractal_noise and value_noise with `per_m` cells a metre.
  const std::vector<float>& fractal(float per_m, int octaves, std::uint32_t seed) {
    return fractal(per_m, per_m * y_m_, octaves, seed);
  }
  /// The same for cells that are not square; `y`: position of the row in cells.
  const std::vector<float>& fractal(float per_m, float y, int octaves, std::uint32_t seed);
  const std::vector<float>& value(float per_m, std::uint32_t seed);

 private:
  const std::vector<float>& scaled(float per_m);

  float y_m_;
  std::vector<float> x_m_, x_;
  std::deque<std::vector<float>> rows_;
};

}  // namespace roadbook
