#pragma once

#include <Eigen/Core>

#include "sim/world.hpp"

namespace roadbook {

/// A ray's end, ready to be coloured.
struct RayEnd {
  Eigen::Vector3f origin;
  Eigen::Vector3f direction;  ///< unit
  float range_m = 0.0F;
  const Triangle* triangle = nullptr;  ///< null: the sky
  float u = 0.0F;                      ///< barycentric
  float v = 0.0F;
};

/// Brightness (0 to 255, may exceed) of what a ray of angular width `pixel_rad` sees.
[[nodiscard]] float shade(const World& world, const RayEnd& end, float pixel_rad);
/// What it sees.
[[nodiscard]] SurfaceClass kind_of(const World& world, const RayEnd& end);

}  // namespace roadbook
