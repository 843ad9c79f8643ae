#pragma once

#include "sim/world/mesh.hpp"

namespace roadbook {

/// A walking person of rounded limbs, origin on the ground, facing x; `phase` [rad] of the stride.
/// Shirt and trousers are `cloth_texture` and the next one.
[[nodiscard]] Mesh make_person(double height_m, double phase, int cloth_texture, int skin_texture);

}  // namespace roadbook
