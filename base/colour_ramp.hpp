#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace roadbook {

/// The colour (red, green, blue) of `part` in 0 to 1, from dark violet over green to yellow; values
/// outside are clamped. Close to "viridis", whose order also colour-blind readers see, and grey
/// prints show.
[[nodiscard]] inline std::array<std::uint8_t, 3> colour_ramp(double part) {
  constexpr std::array<std::array<double, 3>, 5> kStops = {
      {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}}};
  const double place = std::clamp(part, 0.0, 1.0) * 4.0;
  const auto below = std::min<std::size_t>(static_cast<std::size_t>(place), 3);
  const double rest = place - static_cast<double>(below);
  std::array<std::uint8_t, 3> rgb{};
  for (std::size_t k = 0; k < 3; ++k)
    rgb[k] = static_cast<std::uint8_t>(
        std::lround(kStops[below][k] + rest * (kStops[below + 1][k] - kStops[below][k])));
  return rgb;
}

}  // namespace roadbook
