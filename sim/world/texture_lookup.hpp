#pragma once

#include "sim/world/texture.hpp"

namespace roadbook {

// The inner loop of the renderer: half of the time of an image was spent reading textures one place
// after the other (bench/render_bench.cpp).

/// One place. Defines what the eight at once must give, bit by bit.
[[nodiscard]] float texture_at(const TexturePyramid& pyramid, float x, float y, float footprint);

using TextureLookup = void (*)(const TexturePyramid&, Lookups&);

/// The fastest way this processor knows.
[[nodiscard]] TextureLookup choose_texture_lookup();

}  // namespace roadbook
