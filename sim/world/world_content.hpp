#pragma once

#include <vector>

#include "sim/scenario/scenario.hpp"
#include "sim/world/ground.hpp"
#include "sim/world/ground_paint.hpp"
#include "sim/world/layout.hpp"
#include "sim/world/mesh.hpp"
#include "sim/world/moved_patches.hpp"
#include "sim/world/texture.hpp"

namespace roadbook {

/// Everything that a camera can see.
struct World {
  Scenario scenario;
  Layout layout;
  std::vector<MovedPatch> moved;  ///< moved and removed squares, applied in layout and paint
  Ground ground{GroundSpec{}};
  PaintedGround paint;
  Texture ground_texture;  ///< of `paint.brightness`
  Texture fine_stones;     ///< repeats, seen from near
  Texture coarse_stones;
  double fine_texel_m = 0.002;
  double coarse_texel_m = 0.009;
  std::vector<Texture> textures;
  Mesh mesh;                     ///< all static surfaces
  Mesh own_car;                  ///< the measuring car, vehicle frame
  std::vector<Mesh> other_cars;  ///< shapes for moving cars, vehicle frame
  int cloth_texture = 0;         ///< first of two textures a person wears; eight persons
  int skin_texture = 0;
  Texture sky;
  int lamp_texture = -1;  ///< the ceiling, mirrored in the floor; -1: the sky is
  double ceiling_m = 0.0;
  Eigen::Vector2d ceiling_low = Eigen::Vector2d::Zero();
  double ceiling_texel_m = 0.02;
};

}  // namespace roadbook
