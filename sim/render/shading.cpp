#include "sim/render/shading.hpp"

#include <algorithm>
#include <cmath>

namespace roadbook {
namespace {

constexpr float kUnpainted = 85.0F;     // ground beyond the painted one
constexpr float kBelowHorizon = 90.0F;  // where no ground is
constexpr float kDark = 70.0F;          // what a floor mirrors of walls

GroundPlan ground_plan(const World& world) {
  const Canvas& canvas = world.paint.brightness;
  GroundPlan plan;
  plan.low_x = static_cast<float>(canvas.low.x());
  plan.low_y = static_cast<float>(canvas.low.y());
  plan.per_texel = static_cast<float>(1.0 / canvas.texel_m);
  plan.texel = static_cast<float>(canvas.texel_m);
  plan.width = static_cast<float>(world.ground_texture.width());
  plan.height = static_cast<float>(world.ground_texture.height());
  plan.per_fine = static_cast<float>(1.0 / world.fine_texel_m);
  plan.per_coarse = static_cast<float>(1.0 / world.coarse_texel_m);
  plan.glare = static_cast<float>(world.scenario.ground.glare);
  plan.ceiling_x = static_cast<float>(world.ceiling_low.x());
  plan.ceiling_y = static_cast<float>(world.ceiling_low.y());
  plan.ceiling_z = static_cast<float>(world.ceiling_m);
  plan.per_ceiling_texel = static_cast<float>(1.0 / world.ceiling_texel_m);
  return plan;
}

void add_ground_ray(const RayBatch& rays, std::size_t i, GroundRays& ground) {
  const std::size_t k = ground.count++;
  const Eigen::Vector3f& n = rays.triangle[i]->normal;
  ground.ray[k] = static_cast<std::uint16_t>(i);
  ground.dx[k] = rays.dx[i];
  ground.dy[k] = rays.dy[i];
  ground.dz[k] = rays.dz[i];
  ground.range[k] = rays.range_m[i];
  ground.nx[k] = n.x();
  ground.ny[k] = n.y();
  ground.nz[k] = n.z();
  ground.lift[k] = rays.triangle[i]->lift_m;
}

}  // namespace

Shader::Shader(const World& world)
    : world_(world),
      plan_(ground_plan(world)),
      rough_(static_cast<float>(world.scenario.ground.roughness)) {
  if (world.lamp_texture >= 0)
    lamps_ = &world.textures[static_cast<std::size_t>(world.lamp_texture)];
}

void Shader::sky(const Lane& dx,
                 const Lane& dy,
                 const Lane& dz,
                 std::size_t count,
                 float width_rad,
                 Lane& value) const {
  if (count == 0) return;
  alignas(32) Lane x, y;
  sky_places(dx, dy, dz, count, x, y);
  Lookups lookups;
  for (std::size_t k = 0; k < count; ++k)
    if (dz[k] >= 0.0F)
      lookups.add(x[k], y[k], width_rad * kSkyTexelsPerRad, k);
    else
      value[k] = kBelowHorizon;
  world_.sky.look_up(lookups);
  for (std::size_t j = 0; j < lookups.count; ++j) value[lookups.owner[j]] = lookups.value[j];
}

/// Stones of places that have moved (their paint has been moved in its raster), and of equal bays.
void Shader::move(const RayBatch& rays, GroundRays& ground) const {
  const auto& bays = world_.scenario.bays;
  const bool moves = !world_.moved.empty() || bays;
  for (std::size_t k = 0; k < ground.count && moves; ++k) {
    const Eigen::Vector2d place(rays.origin[0] + ground.range[k] * ground.dx[k],
                                rays.origin[1] + ground.range[k] * ground.dy[k]);
    if (const int bay = bays ? bays->bay_of(place) : 0; bay > 0)
      move_stones(plan_, static_cast<float>(bay * bays->step_m()), 0.0F, k, ground);
    for (const MovedPatch& patch : world_.moved)
      if (patch.holds(place))
        move_stones(plan_, static_cast<float>(patch.shift.x()), static_cast<float>(patch.shift.y()),
                    k, ground);
  }
}

/// The painted ground, averaged over every footprint.
void Shader::painted(GroundRays& ground) const {
  Lookups lookups;
  for (std::size_t k = 0; k < ground.count; ++k) {
    ground.value[k] = ground.inside[k] != 0.0F ? 0.0F : kUnpainted;
    if (ground.inside[k] == 0.0F) continue;
    const float first = -0.5F * static_cast<float>(ground.places[k] - 1);
    for (int i = 0; i < ground.places[k]; ++i) {
      const float at = first + static_cast<float>(i);
      lookups.add(ground.x[k] + at * ground.step_x[k], ground.y[k] + at * ground.step_y[k],
                  ground.painted[k], k);
    }
  }
  world_.ground_texture.look_up(lookups);
  static constexpr std::array<float, 4> kShare{0.0F, 1.0F, 1.0F / 2.0F, 1.0F / 3.0F};
  for (std::size_t j = 0; j < lookups.count; ++j) {
    const std::size_t k = lookups.owner[j];
    ground.value[k] += kShare[static_cast<std::size_t>(ground.places[k])] * lookups.value[j];
  }
}

/// Two repeating layers of stones, turned against each other, carry the detail near the car.
void Shader::add_stones(GroundRays& ground) const {
  alignas(32) Lane stones;
  std::fill_n(stones.begin(), ground.count, 0.0F);
  Lookups lookups;
  const auto add = [&](const Texture& layer) {
    layer.look_up(lookups);
    for (std::size_t j = 0; j < lookups.count; ++j)
      stones[lookups.owner[j]] += lookups.value[j] - 128.0F;
    lookups.count = 0;
  };
  for (std::size_t k = 0; k < ground.count; ++k)
    if (ground.footprint[k] < 0.012F)
      lookups.add(ground.fine_x[k], ground.fine_y[k], ground.footprint[k] * plan_.per_fine, k);
  add(world_.fine_stones);
  for (std::size_t k = 0; k < ground.count; ++k)
    if (ground.footprint[k] < 0.09F || ground.inside[k] == 0.0F)
      lookups.add(ground.coarse_x[k], ground.coarse_y[k], ground.footprint[k] * plan_.per_coarse,
                  k);
  add(world_.coarse_stones);
  for (std::size_t k = 0; k < ground.count; ++k)
    ground.value[k] += rough_ * ground.value[k] * (1.0F / 128.0F) * stones[k];
}

/// Reflection in the floor: the ceiling with its lamps, or the sky; blurred, because it is a dull
/// mirror.
void Shader::add_gloss(GroundRays& ground) const {
  if (plan_.glare <= 0.0F) return;
  alignas(32) Lane mirrored;
  if (lamps_ == nullptr) {
    sky(ground.mirror_x, ground.mirror_y, ground.mirror_z, ground.count, 0.1F, mirrored);
  } else {
    std::fill_n(mirrored.begin(), ground.count, kDark);
    Lookups lookups;
    for (std::size_t k = 0; k < ground.count; ++k)
      if (ground.gloss[k] > 0.0F && ground.mirror_z[k] >= 0.02F)
        lookups.add(ground.ceiling_x[k], ground.ceiling_y[k], ground.ceiling_footprint[k], k);
    lamps_->look_up(lookups);
    for (std::size_t j = 0; j < lookups.count; ++j) mirrored[lookups.owner[j]] = lookups.value[j];
  }
  for (std::size_t k = 0; k < ground.count; ++k)
    if (ground.gloss[k] > 0.0F) ground.value[k] += ground.gloss[k] * (mirrored[k] - 40.0F);
}

/// All other surfaces, in runs of one texture.
void Shader::textured(RayBatch& rays, float pixel_rad) const {
  Lookups lookups;
  int texture = kGroundTexture;
  const auto flush = [&] {
    if (lookups.count == 0) return;
    world_.textures[static_cast<std::size_t>(texture)].look_up(lookups);
    for (std::size_t j = 0; j < lookups.count; ++j) {
      const std::size_t i = lookups.owner[j];
      rays.brightness[i] = rays.triangle[i]->light * lookups.value[j];
    }
    lookups.count = 0;
  };
  for (std::size_t i = 0; i < rays.count; ++i) {
    if (rays.triangle[i] == nullptr || rays.triangle[i]->texture == kGroundTexture) continue;
    const Triangle& t = *rays.triangle[i];
    if (t.texture != texture) flush();
    texture = t.texture;
    const float u = rays.u[i];
    const float v = rays.v[i];
    const float w = 1.0F - u - v;
    const float x = w * t.uv[0].x() + u * t.uv[1].x() + v * t.uv[2].x();
    const float y = w * t.uv[0].y() + u * t.uv[1].y() + v * t.uv[2].y();
    const float facing =
        std::max(0.15F, std::abs(t.normal.x() * rays.dx[i] + t.normal.y() * rays.dy[i] +
                                 t.normal.z() * rays.dz[i]));
    // Between the two widths of a slanted footprint: neither shimmers nor blurs much.
    lookups.add(x, y, pixel_rad * rays.range_m[i] / (std::sqrt(facing) * t.texel_m), i);
  }
  flush();
}

void Shader::shade(RayBatch& rays, float pixel_rad) const {
  alignas(32) Lane dx, dy, dz, value;
  std::array<std::size_t, RayBatch::kMost> above;
  std::size_t sky_rays = 0;
  GroundRays ground;
  for (std::size_t i = 0; i < rays.count; ++i) {
    if (rays.triangle[i] == nullptr) {
      dx[sky_rays] = rays.dx[i];
      dy[sky_rays] = rays.dy[i];
      dz[sky_rays] = rays.dz[i];
      above[sky_rays++] = i;
    } else if (rays.triangle[i]->texture == kGroundTexture) {
      add_ground_ray(rays, i, ground);
    }
  }
  sky(dx, dy, dz, sky_rays, pixel_rad, value);
  for (std::size_t k = 0; k < sky_rays; ++k) rays.brightness[above[k]] = value[k];
  if (ground.count > 0) {
    footprints(plan_, rays.origin, pixel_rad, ground);
    move(rays, ground);
    painted(ground);
    add_stones(ground);
    add_gloss(ground);
    for (std::size_t k = 0; k < ground.count; ++k) rays.brightness[ground.ray[k]] = ground.value[k];
  }
  textured(rays, pixel_rad);
}

SurfaceClass Shader::kind(const RayBatch& rays, std::size_t ray) const {
  const Triangle* triangle = rays.triangle[ray];
  if (triangle == nullptr) return SurfaceClass::kSky;
  if (triangle->texture != kGroundTexture) return triangle->kind;
  const auto px = static_cast<double>(rays.origin[0] + rays.range_m[ray] * rays.dx[ray]);
  const auto py = static_cast<double>(rays.origin[1] + rays.range_m[ray] * rays.dy[ray]);
  const Canvas& kind = world_.paint.kind;
  const Eigen::Vector2d texel = kind.texel(Eigen::Vector2d(px, py));
  const int x = static_cast<int>(std::lround(texel.x()));
  const int y = static_cast<int>(std::lround(texel.y()));
  if (x < 0 || y < 0 || x >= kind.image.cols || y >= kind.image.rows) return SurfaceClass::kRoad;
  return static_cast<SurfaceClass>(kind.image.at<std::uint8_t>(y, x));
}

}  // namespace roadbook
