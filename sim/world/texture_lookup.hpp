#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace roadbook {

// The inner loop of the renderer: lookups in textures, eight at once (bench/render_bench.cpp).

/// Positions to look up in one texture, and the values found. Stored component by component,
/// because eight are read at once.
struct Lookups {
  static constexpr std::size_t kMost = 384;

  std::size_t count = 0;
  alignas(32) std::array<float, kMost> x, y, footprint, value;
  std::array<std::uint16_t, kMost> owner;  ///< index that the caller gives to each lookup

  void add(float at_x, float at_y, float wide, std::size_t whose) {
    x[count] = at_x;
    y[count] = at_y;
    footprint[count] = wide;
    owner[count++] = static_cast<std::uint16_t>(whose);
  }
};

/// All halved versions of a texture in one block of memory. Every level has an additional column
/// and row (copies of the first ones, or of the last ones), so that every texel has a right and a
/// lower neighbour.
struct TexturePyramid {
  static constexpr std::size_t kMostLevels = 16;

  std::vector<std::uint8_t> texels;
  std::array<int, kMostLevels> offset{}, stride{}, width{}, height{};
  int last = -1;  ///< coarsest level
  bool tiled = false;
};

/// Looks up one position. It defines the result; vectorised versions must give the same bits.
[[nodiscard]] float texture_at(const TexturePyramid& pyramid, float x, float y, float footprint);

using TextureLookup = void (*)(const TexturePyramid&, Lookups&);

/// Returns the fastest implementation for this processor.
[[nodiscard]] TextureLookup choose_texture_lookup();

}  // namespace roadbook
