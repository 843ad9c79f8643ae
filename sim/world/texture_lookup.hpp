#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace roadbook {

// The inner loop of the renderer: half of the time of an image was spent reading textures one place
// after the other (bench/render_bench.cpp).

/// Places to look up in one texture, and the values found. Component by component, because eight
/// are read at once.
struct Lookups {
  static constexpr std::size_t kMost = 384;

  std::size_t count = 0;
  alignas(32) std::array<float, kMost> x, y, footprint, value;
  std::array<std::uint16_t, kMost> owner;  ///< for the caller: whom the value is for

  void add(float at_x, float at_y, float wide, std::size_t whose) {
    x[count] = at_x;
    y[count] = at_y;
    footprint[count] = wide;
    owner[count++] = static_cast<std::uint16_t>(whose);
  }
};

/// All halved versions of a texture in one piece of memory. Every level has one column and one row
/// more than it shows (the first ones again, or the last ones), so that the right and the lower
/// neighbour of a texel are always there.
struct TexturePyramid {
  static constexpr std::size_t kMostLevels = 16;

  std::vector<std::uint8_t> texels;
  std::array<int, kMostLevels> offset{}, stride{}, width{}, height{};
  int last = -1;  ///< coarsest level
  bool tiled = false;
};

/// One place. Defines what the eight at once must give, bit by bit.
[[nodiscard]] float texture_at(const TexturePyramid& pyramid, float x, float y, float footprint);

using TextureLookup = void (*)(const TexturePyramid&, Lookups&);

/// The fastest way this processor knows.
[[nodiscard]] TextureLookup choose_texture_lookup();

}  // namespace roadbook
