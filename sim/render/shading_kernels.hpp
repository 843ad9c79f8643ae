#pragma once

#include <array>
#include <cstddef>

#include "sim/render/ray_scene.hpp"

namespace roadbook {

// Geometry of shading without branches, which the compiler vectorises to eight pixels at a time.

using Lane = std::array<float, RayBatch::kMost>;

/// Raster, roughness and gloss of the painted ground.
struct GroundPlan {
  float low_x = 0.0F, low_y = 0.0F, per_texel = 1.0F, texel = 1.0F;
  float width = 0.0F, height = 0.0F;  ///< [texels]
  float per_fine = 1.0F, per_coarse = 1.0F;
  float glare = 0.0F;
  float ceiling_x = 0.0F, ceiling_y = 0.0F, ceiling_z = 0.0F, per_ceiling_texel = 1.0F;
};

/// Rays that end on the ground.
struct GroundRays {
  std::size_t count = 0;
  std::array<std::uint16_t, RayBatch::kMost> ray;  ///< index in the batch
  alignas(32) Lane dx, dy, dz, range, nx, ny, nz;
  alignas(32) Lane lift;  ///< height of the storey [m]

  // Filled by `footprints`. The painted ground is looked up at `places` points in a row.
  alignas(32) Lane x, y;  ///< [texels]
  alignas(32) Lane step_x, step_y, painted;
  alignas(32) Lane inside;  ///< 1 or 0: the ground is painted here
  std::array<int, RayBatch::kMost> places;
  alignas(32) Lane fine_x, fine_y, coarse_x, coarse_y;
  alignas(32) Lane footprint;                     ///< [m]
  alignas(32) Lane gloss;                         ///< share of what is mirrored
  alignas(32) Lane mirror_x, mirror_y, mirror_z;  ///< direction after the ground
  alignas(32) Lane ceiling_x, ceiling_y,
      ceiling_footprint;  ///< [texels] where it meets the ceiling

  alignas(32) Lane value;
};

void footprints(const GroundPlan& plan,
                const std::array<float, 3>& origin,
                float pixel_rad,
                GroundRays& ground);

/// Shifts the texture lookup of the stones for ray `k` by (x, y) [m].
void move_stones(const GroundPlan& plan, float x, float y, std::size_t k, GroundRays& ground);

/// Texel positions of directions in the texture of the sky (4096 texels around).
void sky_places(
    const Lane& dx, const Lane& dy, const Lane& dz, std::size_t count, Lane& x, Lane& y);
constexpr float kSkyTexelsPerRad = 4096.0F / 6.28318531F;

/// Directions of a camera's rays in the world; R column by column.
void turn(const std::array<float, 9>& R, RayBatch& rays);

}  // namespace roadbook
