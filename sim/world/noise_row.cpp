#include "sim/world/noise_row.hpp"

namespace roadbook {

NoiseRow::NoiseRow(const Canvas& canvas, float y_m)
    : y_m_(y_m), x_m_(static_cast<std::size_t>(canvas.image.cols)), x_(x_m_.size()) {
  for (std::size_t i = 0; i < x_m_.size(); ++i)
    x_m_[i] = static_cast<float>(canvas.low.x() + (static_cast<double>(i) + 0.5) * canvas.texel_m);
}

const std::vector<float>& NoiseRow::scaled(float per_m) {
  for (std::size_t i = 0; i < x_.size(); ++i) x_[i] = per_m * x_m_[i];
  return x_;
}

const std::vector<float>& NoiseRow::fractal(float per_m, float y, int octaves, std::uint32_t seed) {
  auto& row = rows_.emplace_back(x_m_.size());
  fractal_noise_row(scaled(per_m), y, octaves, seed, row);
  return row;
}

const std::vector<float>& NoiseRow::value(float per_m, std::uint32_t seed) {
  auto& row = rows_.emplace_back(x_m_.size());
  value_noise_row(scaled(per_m), per_m * y_m_, seed, row);
  return row;
}

}  // namespace roadbook
