#include "sim/shading.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace roadbook {
namespace {

float sky(const World& world, const Eigen::Vector3f& d, float pixel_rad) {
  const float per_rad = 4096.0F / (2.0F * std::numbers::pi_v<float>);
  const float azimuth = std::atan2(d.y(), d.x());
  const float elevation = std::asin(std::clamp(d.z(), -1.0F, 1.0F));
  if (elevation < 0.0F) return 90.0F;
  return world.sky.sample(azimuth * per_rad + 4096.0F, std::min(elevation * per_rad, 1020.0F),
                          pixel_rad * per_rad);
}

/// What the floor mirrors: the ceiling with its lamps, or the sky; blurred, it is a dull mirror.
float mirrored(const World& world,
               const Eigen::Vector3f& p,
               const Eigen::Vector3f& d,
               const Eigen::Vector3f& n) {
  const Eigen::Vector3f r = d - 2.0F * d.dot(n) * n;
  if (world.lamp_texture < 0) return sky(world, r, 0.1F);
  if (r.z() < 0.02F) return 70.0F;
  const float t = std::min((static_cast<float>(world.ceiling_m) - p.z()) / r.z(), 60.0F);
  const auto texel = static_cast<float>(world.ceiling_texel_m);
  const float x = (p.x() + t * r.x() - static_cast<float>(world.ceiling_low.x())) / texel;
  const float y = (p.y() + t * r.y() - static_cast<float>(world.ceiling_low.y())) / texel;
  return world.textures[static_cast<std::size_t>(world.lamp_texture)].sample(
      x, y, (0.2F + 0.08F * t) / texel);
}

float shade_ground(const World& world, const RayEnd& end, float pixel_rad) {
  const Eigen::Vector3f p = end.origin + end.range_m * end.direction;
  const Eigen::Vector3f n =
      world.ground.normal(static_cast<double>(p.x()), static_cast<double>(p.y())).cast<float>();
  const float facing = std::max(0.02F, -end.direction.dot(n));
  const float narrow = pixel_rad * end.range_m;
  const float wide = narrow / facing;
  const Canvas& canvas = world.paint.brightness;
  const auto texel = static_cast<float>(canvas.texel_m);
  const float x = (p.x() - static_cast<float>(canvas.low.x())) / texel - 0.5F;
  const float y = (p.y() - static_cast<float>(canvas.low.y())) / texel - 0.5F;
  const bool painted = x > 0.0F && y > 0.0F && x < static_cast<float>(canvas.image.cols) &&
                       y < static_cast<float>(canvas.image.rows);
  float value = 85.0F;
  if (painted) {
    // A long footprint is a row of short ones along the ray.
    const int places =
        std::clamp(static_cast<int>(0.6F * wide / std::max(narrow, texel) + 0.7F), 1, 4);
    const float length = end.direction.head<2>().norm() + 1e-6F;
    const float step = wide / static_cast<float>(places) / texel;
    const float dx = end.direction.x() / length * step;
    const float dy = end.direction.y() / length * step;
    const float footprint = std::max(narrow, 0.7F * wide / static_cast<float>(places)) / texel;
    float sum = 0.0F;
    for (int i = 0; i < places; ++i) {
      const float along = static_cast<float>(i) - 0.5F * static_cast<float>(places - 1);
      sum += world.ground_texture.sample(x + along * dx, y + along * dy, footprint);
    }
    value = sum / static_cast<float>(places);
  }
  const float footprint = std::sqrt(narrow * wide);
  const auto rough = static_cast<float>(world.scenario.ground.roughness);
  if (footprint < 0.012F) {
    const auto fine = 1.0F / static_cast<float>(world.fine_texel_m);
    value +=
        rough * (value / 128.0F) *
        (world.fine_stones.sample((0.8F * p.x() + 0.6F * p.y()) * fine + 4e5F,
                                  (0.8F * p.y() - 0.6F * p.x()) * fine + 4e5F, footprint * fine) -
         128.0F);
  }
  if (footprint < 0.09F || !painted) {
    const auto coarse = 1.0F / static_cast<float>(world.coarse_texel_m);
    value += rough * (value / 128.0F) *
             (world.coarse_stones.sample((0.28F * p.x() - 0.96F * p.y()) * coarse + 4e5F,
                                         (0.96F * p.x() + 0.28F * p.y()) * coarse + 4e5F,
                                         footprint * coarse) -
              128.0F);
  }
  const auto glare = static_cast<float>(world.scenario.ground.glare);
  const float away = 1.0F - facing;
  const float gloss = glare * (0.03F + away * away * away);
  if (gloss > 0.01F) value += gloss * (mirrored(world, p, end.direction, n) - 40.0F);
  return value;
}

}  // namespace

float shade(const World& world, const RayEnd& end, float pixel_rad) {
  if (end.triangle == nullptr) return sky(world, end.direction, pixel_rad);
  const Triangle& t = *end.triangle;
  if (t.texture == kGroundTexture) return shade_ground(world, end, pixel_rad);
  const Eigen::Vector2f uv = (1.0F - end.u - end.v) * t.uv[0] + end.u * t.uv[1] + end.v * t.uv[2];
  const Eigen::Vector3f n = (t.corner[1] - t.corner[0]).cross(t.corner[2] - t.corner[0]);
  const float facing = std::max(0.15F, std::abs(n.dot(end.direction)) / (n.norm() + 1e-12F));
  // Between the two widths of a slanted footprint: neither shimmers nor blurs much.
  const float footprint = pixel_rad * end.range_m / std::sqrt(facing) / t.texel_m;
  return t.light *
         world.textures[static_cast<std::size_t>(t.texture)].sample(uv.x(), uv.y(), footprint);
}

SurfaceClass kind_of(const World& world, const RayEnd& end) {
  if (end.triangle == nullptr) return SurfaceClass::kSky;
  if (end.triangle->texture != kGroundTexture) return end.triangle->kind;
  const Eigen::Vector3f p = end.origin + end.range_m * end.direction;
  const Canvas& kind = world.paint.kind;
  const Eigen::Vector2d texel =
      kind.texel(Eigen::Vector2d(static_cast<double>(p.x()), static_cast<double>(p.y())));
  const int x = static_cast<int>(std::lround(texel.x()));
  const int y = static_cast<int>(std::lround(texel.y()));
  if (x < 0 || y < 0 || x >= kind.image.cols || y >= kind.image.rows) return SurfaceClass::kRoad;
  return static_cast<SurfaceClass>(kind.image.at<std::uint8_t>(y, x));
}

}  // namespace roadbook
