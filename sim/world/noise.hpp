#pragma once

#include <cstdint>
#include <span>

namespace roadbook {

// Smooth noise, a pure function of position and seed. Painting a place spends most of its time
// here.

/// Noise in [-1, 1] with one random value for each lattice cell.
[[nodiscard]] float value_noise(float x, float y, std::uint32_t seed);
/// Sum of `octaves`, each half as large and twice as fine as the one before, in about [-1, 1].
[[nodiscard]] float fractal_noise(float x, float y, int octaves, std::uint32_t seed);

/// The same bits for a row of positions with the same y, several times faster. `x` and `out` have
/// equal length.
void value_noise_row(std::span<const float> x, float y, std::uint32_t seed, std::span<float> out);
void fractal_noise_row(
    std::span<const float> x, float y, int octaves, std::uint32_t seed, std::span<float> out);
/// The same for positions with a y each.
void fractal_noise_at(std::span<const float> x,
                      std::span<const float> y,
                      int octaves,
                      std::uint32_t seed,
                      std::span<float> out);

}  // namespace roadbook
