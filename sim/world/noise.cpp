#include "sim/world/noise.hpp"

#include <algorithm>
#include <cstddef>

#include "base/target_clones.hpp"

namespace roadbook {
namespace {

inline std::uint32_t hash(std::uint32_t x, std::uint32_t y, std::uint32_t seed) {
  std::uint32_t h = x * 0x9e3779b1U ^ (y * 0x85ebca77U + 0x7f4a7c15U) ^ seed * 0xc2b2ae3dU;
  h ^= h >> 15U;
  h *= 0x2c1b3c6dU;
  h ^= h >> 12U;
  h *= 0x297a2d39U;
  return h ^ (h >> 15U);
}

/// Value in [-1, 1] of a lattice point. Through the upper 24 bits, which a float holds exactly: a
/// conversion that processors have for many numbers at once.
inline float lattice(int x, int y, std::uint32_t seed) {
  const std::uint32_t h = hash(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), seed);
  return static_cast<float>(static_cast<int>(h >> 8U)) * (2.0F / 16777215.0F) - 1.0F;
}

/// The library's floor is a call on baseline x86-64.
inline int whole_below(float x) {
  const int i = static_cast<int>(x);
  return i - (static_cast<float>(i) > x ? 1 : 0);
}

inline float noise_at(float x, float y, std::uint32_t seed) {
  const int ix = whole_below(x);
  const int iy = whole_below(y);
  const float u = x - static_cast<float>(ix);
  const float v = y - static_cast<float>(iy);
  const float a = u * u * (3.0F - 2.0F * u);
  const float b = v * v * (3.0F - 2.0F * v);
  const float n00 = lattice(ix, iy, seed);
  const float n10 = lattice(ix + 1, iy, seed);
  const float n01 = lattice(ix, iy + 1, seed);
  const float n11 = lattice(ix + 1, iy + 1, seed);
  const float top = n00 + a * (n10 - n00);
  return top + b * (n01 + a * (n11 - n01) - top);
}

ROADBOOK_CLONES void add_octave(const float* x,
                                std::size_t count,
                                float fine,
                                float y,
                                float size,
                                std::uint32_t seed,
                                float* sum) {
  for (std::size_t i = 0; i < count; ++i) sum[i] += size * noise_at(fine * x[i], y, seed);
}

ROADBOOK_CLONES void add_octave_at(const float* x,
                                   const float* y,
                                   std::size_t count,
                                   float fine,
                                   float size,
                                   std::uint32_t seed,
                                   float* sum) {
  for (std::size_t i = 0; i < count; ++i) sum[i] += size * noise_at(fine * x[i], fine * y[i], seed);
}

}  // namespace

float value_noise(float x, float y, std::uint32_t seed) { return noise_at(x, y, seed); }

float fractal_noise(float x, float y, int octaves, std::uint32_t seed) {
  float sum = 0.0F;
  float size = 0.5F;
  for (int i = 0; i < octaves; ++i) {
    sum += size * noise_at(x, y, seed + static_cast<std::uint32_t>(i) * 101U);
    x *= 2.0F;
    y *= 2.0F;
    size *= 0.5F;
  }
  return sum;
}

void value_noise_row(std::span<const float> x, float y, std::uint32_t seed, std::span<float> out) {
  std::fill(out.begin(), out.end(), 0.0F);
  add_octave(x.data(), x.size(), 1.0F, y, 1.0F, seed, out.data());
}

void fractal_noise_row(
    std::span<const float> x, float y, int octaves, std::uint32_t seed, std::span<float> out) {
  std::fill(out.begin(), out.end(), 0.0F);
  float fine = 1.0F;  // powers of two: products are exact, as repeated doubling is
  float size = 0.5F;
  for (int i = 0; i < octaves; ++i) {
    add_octave(x.data(), x.size(), fine, fine * y, size,
               seed + static_cast<std::uint32_t>(i) * 101U, out.data());
    fine *= 2.0F;
    size *= 0.5F;
  }
}

void fractal_noise_at(std::span<const float> x,
                      std::span<const float> y,
                      int octaves,
                      std::uint32_t seed,
                      std::span<float> out) {
  std::fill(out.begin(), out.end(), 0.0F);
  float fine = 1.0F;
  float size = 0.5F;
  for (int i = 0; i < octaves; ++i) {
    add_octave_at(x.data(), y.data(), x.size(), fine, size,
                  seed + static_cast<std::uint32_t>(i) * 101U, out.data());
    fine *= 2.0F;
    size *= 0.5F;
  }
}

}  // namespace roadbook
