#include "sim/shading.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace roadbook {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

/// Four-quadrant arc tangent to 1e-5 rad (Abramowitz and Stegun 4.4.49), a fraction of a texel of
/// the sky; the library's costs more than the rest of the pixel.
float arc_tangent(float y, float x) {
  const float ax = std::abs(x);
  const float ay = std::abs(y);
  const float q = std::min(ax, ay) / (std::max(ax, ay) + 1e-20F);
  const float s = q * q;
  float a =
      q * (0.9998660F + s * (-0.3302995F + s * (0.1801410F + s * (-0.0851330F + s * 0.0208351F))));
  if (ay > ax) a = 0.5F * kPi - a;
  if (x < 0.0F) a = kPi - a;
  return y < 0.0F ? -a : a;
}

}  // namespace

Shader::Shader(const World& world)
    : world_(world),
      low_x_(static_cast<float>(world.paint.brightness.low.x())),
      low_y_(static_cast<float>(world.paint.brightness.low.y())),
      per_texel_(static_cast<float>(1.0 / world.paint.brightness.texel_m)),
      texel_(static_cast<float>(world.paint.brightness.texel_m)),
      width_(static_cast<float>(world.paint.brightness.image.cols)),
      height_(static_cast<float>(world.paint.brightness.image.rows)),
      per_fine_(static_cast<float>(1.0 / world.fine_texel_m)),
      per_coarse_(static_cast<float>(1.0 / world.coarse_texel_m)),
      rough_(static_cast<float>(world.scenario.ground.roughness)),
      glare_(static_cast<float>(world.scenario.ground.glare)),
      ceiling_z_(static_cast<float>(world.ceiling_m)),
      ceiling_x_(static_cast<float>(world.ceiling_low.x())),
      ceiling_y_(static_cast<float>(world.ceiling_low.y())),
      per_ceiling_texel_(static_cast<float>(1.0 / world.ceiling_texel_m)) {
  if (world.lamp_texture >= 0)
    lamps_ = &world.textures[static_cast<std::size_t>(world.lamp_texture)];
}

float Shader::sky(const Eigen::Vector3f& d, float pixel_rad) const {
  constexpr float kPerRad = 4096.0F / (2.0F * kPi);
  if (d.z() < 0.0F) return 90.0F;
  const float elevation = arc_tangent(d.z(), std::sqrt(d.x() * d.x() + d.y() * d.y()));
  return world_.sky.sample(arc_tangent(d.y(), d.x()) * kPerRad + 4096.0F,
                           std::min(elevation * kPerRad, 1020.0F), pixel_rad * kPerRad);
}

/// What the floor mirrors: the ceiling with its lamps, or the sky; blurred, it is a dull mirror.
float Shader::mirrored(const Eigen::Vector3f& p,
                       const Eigen::Vector3f& d,
                       const Eigen::Vector3f& n) const {
  const Eigen::Vector3f r = d - 2.0F * d.dot(n) * n;
  if (lamps_ == nullptr) return sky(r, 0.1F);
  if (r.z() < 0.02F) return 70.0F;
  const float t = std::min((ceiling_z_ - p.z()) / r.z(), 60.0F);
  return lamps_->sample((p.x() + t * r.x() - ceiling_x_) * per_ceiling_texel_,
                        (p.y() + t * r.y() - ceiling_y_) * per_ceiling_texel_,
                        (0.2F + 0.08F * t) * per_ceiling_texel_);
}

/// The painted ground at a texel. A long footprint is a row of short ones along the ray.
float Shader::painted(float x, float y, const Eigen::Vector3f& d, float narrow, float wide) const {
  const int places =
      std::clamp(static_cast<int>(0.5F * wide / std::max(narrow, texel_) + 0.5F), 1, 3);
  if (places == 1)
    return world_.ground_texture.sample(x, y, std::max(narrow, 0.7F * wide) * per_texel_);
  const auto n = static_cast<float>(places);
  const float step = wide / n * per_texel_;
  const float footprint = std::max(narrow * per_texel_, 0.7F * step);
  const float along = step / (std::sqrt(d.x() * d.x() + d.y() * d.y()) + 1e-6F);
  float sum = 0.0F;
  for (int i = 0; i < places; ++i) {
    const float at = (static_cast<float>(i) - 0.5F * (n - 1.0F)) * along;
    sum += world_.ground_texture.sample(x + at * d.x(), y + at * d.y(), footprint);
  }
  return sum / n;
}

float Shader::ground(const RayEnd& end, float pixel_rad) const {
  const Eigen::Vector3f p = end.origin + end.range_m * end.direction;
  const Eigen::Vector3f& n = end.triangle->normal;
  const float facing = std::max(0.02F, -end.direction.dot(n));
  const float narrow = pixel_rad * end.range_m;
  const float wide = narrow / facing;
  const float x = (p.x() - low_x_) * per_texel_ - 0.5F;
  const float y = (p.y() - low_y_) * per_texel_ - 0.5F;
  const bool inside = x > 0.0F && y > 0.0F && x < width_ && y < height_;
  float value = inside ? painted(x, y, end.direction, narrow, wide) : 85.0F;
  // Two repeating layers of stones, turned against each other, carry the detail near the car.
  const float footprint = std::sqrt(narrow * wide);
  const float contrast = rough_ * value * (1.0F / 128.0F);
  float stones = 0.0F;
  if (footprint < 0.012F)
    stones += world_.fine_stones.sample((0.8F * p.x() + 0.6F * p.y()) * per_fine_ + 4e5F,
                                        (0.8F * p.y() - 0.6F * p.x()) * per_fine_ + 4e5F,
                                        footprint * per_fine_) -
              128.0F;
  if (footprint < 0.09F || !inside)
    stones += world_.coarse_stones.sample((0.28F * p.x() - 0.96F * p.y()) * per_coarse_ + 4e5F,
                                          (0.96F * p.x() + 0.28F * p.y()) * per_coarse_ + 4e5F,
                                          footprint * per_coarse_) -
              128.0F;
  value += contrast * stones;
  // Gloss grows towards grazing views (after Schlick) and is nothing from above.
  const float away = 1.0F - facing;
  const float gloss = glare_ * (away * away * away - 0.03F);
  if (gloss > 0.0F) value += gloss * (mirrored(p, end.direction, n) - 40.0F);
  return value;
}

float Shader::shade(const RayEnd& end, float pixel_rad) const {
  if (end.triangle == nullptr) return sky(end.direction, pixel_rad);
  const Triangle& t = *end.triangle;
  if (t.texture == kGroundTexture) return ground(end, pixel_rad);
  const float w = 1.0F - end.u - end.v;
  const float x = w * t.uv[0].x() + end.u * t.uv[1].x() + end.v * t.uv[2].x();
  const float y = w * t.uv[0].y() + end.u * t.uv[1].y() + end.v * t.uv[2].y();
  const float facing = std::max(0.15F, std::abs(t.normal.dot(end.direction)));
  // Between the two widths of a slanted footprint: neither shimmers nor blurs much.
  const float footprint = pixel_rad * end.range_m / (std::sqrt(facing) * t.texel_m);
  return t.light * world_.textures[static_cast<std::size_t>(t.texture)].sample(x, y, footprint);
}

SurfaceClass Shader::kind(const RayEnd& end) const {
  if (end.triangle == nullptr) return SurfaceClass::kSky;
  if (end.triangle->texture != kGroundTexture) return end.triangle->kind;
  const Eigen::Vector3f p = end.origin + end.range_m * end.direction;
  const Canvas& kind = world_.paint.kind;
  const Eigen::Vector2d texel =
      kind.texel(Eigen::Vector2d(static_cast<double>(p.x()), static_cast<double>(p.y())));
  const int x = static_cast<int>(std::lround(texel.x()));
  const int y = static_cast<int>(std::lround(texel.y()));
  if (x < 0 || y < 0 || x >= kind.image.cols || y >= kind.image.rows) return SurfaceClass::kRoad;
  return static_cast<SurfaceClass>(kind.image.at<std::uint8_t>(y, x));
}

}  // namespace roadbook
