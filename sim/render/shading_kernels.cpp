#include "sim/render/shading_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/target_clones.hpp"

namespace roadbook {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

/// Four-quadrant arc tangent to 1e-5 rad (Abramowitz and Stegun 4.4.49), a fraction of a texel of
/// the sky.
inline float arc_tangent(float y, float x) {
  const float ax = std::abs(x);
  const float ay = std::abs(y);
  const float small = ax < ay ? ax : ay;
  const float large = ax < ay ? ay : ax;
  const float q = small / (large + 1e-20F);
  const float s = q * q;
  float a =
      q * (0.9998660F + s * (-0.3302995F + s * (0.1801410F + s * (-0.0851330F + s * 0.0208351F))));
  a = ay > ax ? 0.5F * kPi - a : a;
  a = x < 0.0F ? kPi - a : a;
  return y < 0.0F ? -a : a;
}

// Two repeating layers of stones, turned against each other [m].
inline float fine_x(float x, float y) { return 0.8F * x + 0.6F * y; }
inline float fine_y(float x, float y) { return 0.8F * y - 0.6F * x; }
inline float coarse_x(float x, float y) { return 0.28F * x - 0.96F * y; }
inline float coarse_y(float x, float y) { return 0.96F * x + 0.28F * y; }

}  // namespace

ROADBOOK_CLONES void footprints(const GroundPlan& plan,
                                const std::array<float, 3>& origin,
                                float pixel_rad,
                                GroundRays& g) {
  const GroundPlan c = plan;
  const float ox = origin[0];
  const float oy = origin[1];
  const float oz = origin[2];
  for (std::size_t k = 0; k < g.count; ++k) {
    const float dx = g.dx[k];
    const float dy = g.dy[k];
    const float dz = g.dz[k];
    const float px = ox + g.range[k] * dx;
    const float py = oy + g.range[k] * dy;
    const float pz = oz + g.range[k] * dz;
    const float along_normal = dx * g.nx[k] + dy * g.ny[k] + dz * g.nz[k];
    const float facing = -along_normal > 0.02F ? -along_normal : 0.02F;
    const float narrow = pixel_rad * g.range[k];
    const float wide = narrow / facing;
    const float x = (px - c.low_x) * c.per_texel - 0.5F;
    const float y = (py - c.low_y) * c.per_texel - 0.5F;
    g.x[k] = x;
    g.y[k] = y;
    const bool in_x = x > 0.0F && x < c.width;
    const bool in_y = y > 0.0F && y < c.height;
    g.inside[k] = in_x && in_y ? 1.0F : 0.0F;
    // A long footprint is a row of up to three short ones along the ray.
    const float thick = narrow > c.texel ? narrow : c.texel;
    int places = static_cast<int>(0.5F * wide / thick + 0.5F);
    places = places < 1 ? 1 : places;
    places = places > 3 ? 3 : places;
    g.places[k] = places;
    const float step = wide / static_cast<float>(places) * c.per_texel;
    const float across = narrow * c.per_texel;
    g.painted[k] = across > 0.7F * step ? across : 0.7F * step;
    const float along = step / (std::sqrt(dx * dx + dy * dy) + 1e-6F);
    g.step_x[k] = along * dx;
    g.step_y[k] = along * dy;
    g.fine_x[k] = fine_x(px, py) * c.per_fine + 4e5F;
    g.fine_y[k] = fine_y(px, py) * c.per_fine + 4e5F;
    g.coarse_x[k] = coarse_x(px, py) * c.per_coarse + 4e5F;
    g.coarse_y[k] = coarse_y(px, py) * c.per_coarse + 4e5F;
    g.footprint[k] = std::sqrt(narrow * wide);
    // Gloss grows towards grazing views (after Schlick) and is nothing from above.
    const float away = 1.0F - facing;
    g.gloss[k] = c.glare * (away * away * away - 0.03F);
    const float rx = dx - 2.0F * along_normal * g.nx[k];
    const float ry = dy - 2.0F * along_normal * g.ny[k];
    const float rz = dz - 2.0F * along_normal * g.nz[k];
    g.mirror_x[k] = rx;
    g.mirror_y[k] = ry;
    g.mirror_z[k] = rz;
    const float up = rz > 0.02F ? rz : 0.02F;
    const float high = (c.ceiling_z + g.lift[k] - pz) / up;
    const float t = high < 60.0F ? high : 60.0F;
    g.ceiling_x[k] = (px + t * rx - c.ceiling_x) * c.per_ceiling_texel;
    g.ceiling_y[k] = (py + t * ry - c.ceiling_y) * c.per_ceiling_texel;
    g.ceiling_footprint[k] = (0.2F + 0.08F * t) * c.per_ceiling_texel;
  }
}

void move_stones(const GroundPlan& c, float x, float y, std::size_t k, GroundRays& g) {
  g.fine_x[k] -= fine_x(x, y) * c.per_fine;
  g.fine_y[k] -= fine_y(x, y) * c.per_fine;
  g.coarse_x[k] -= coarse_x(x, y) * c.per_coarse;
  g.coarse_y[k] -= coarse_y(x, y) * c.per_coarse;
}

ROADBOOK_CLONES void sky_places(
    const Lane& dx, const Lane& dy, const Lane& dz, std::size_t count, Lane& x, Lane& y) {
  for (std::size_t k = 0; k < count; ++k) {
    const float level = std::sqrt(dx[k] * dx[k] + dy[k] * dy[k]);
    const float high = arc_tangent(dz[k], level) * kSkyTexelsPerRad;
    x[k] = arc_tangent(dy[k], dx[k]) * kSkyTexelsPerRad + 4096.0F;
    y[k] = high < 1020.0F ? high : 1020.0F;
  }
}

ROADBOOK_CLONES void turn(const std::array<float, 9>& R, RayBatch& rays) {
  const float r0 = R[0], r1 = R[1], r2 = R[2], r3 = R[3], r4 = R[4], r5 = R[5], r6 = R[6],
              r7 = R[7], r8 = R[8];
  for (std::size_t k = 0; k < rays.count; ++k) {
    const float x = rays.dx[k];
    const float y = rays.dy[k];
    const float z = rays.dz[k];
    rays.dx[k] = r0 * x + r3 * y + r6 * z;
    rays.dy[k] = r1 * x + r4 * y + r7 * z;
    rays.dz[k] = r2 * x + r5 * y + r8 * z;
  }
}

}  // namespace roadbook
