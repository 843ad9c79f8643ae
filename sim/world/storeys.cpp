#include "sim/world/storeys.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/world/surface_paint.hpp"

namespace roadbook {
namespace {

constexpr double kBeamTexel = 0.012;
constexpr double kBeamHeight = 0.36;
constexpr double kBeamWidth = 0.3;

// The parts of a rectangle beside an opening.
std::vector<Eigen::AlignedBox2d> around(const Eigen::AlignedBox2d& all,
                                        const Eigen::AlignedBox2d& opening) {
  const Eigen::AlignedBox2d hole = all.intersection(opening);
  const Eigen::Vector2d a = all.min(), b = hole.min(), c = hole.max(), d = all.max();
  std::vector<Eigen::AlignedBox2d> parts{
      {a, Eigen::Vector2d(b.x(), d.y())},
      {Eigen::Vector2d(c.x(), a.y()), d},
      {Eigen::Vector2d(b.x(), a.y()), Eigen::Vector2d(c.x(), b.y())},
      {Eigen::Vector2d(b.x(), c.y()), Eigen::Vector2d(c.x(), d.y())}};
  std::erase_if(parts, [](const auto& part) { return part.sizes().minCoeff() <= 0.0; });
  return parts;
}

void add_ground_quad(World& world, const std::array<Eigen::Vector3d, 4>& corner, double lift) {
  const std::array<Eigen::Vector2d, 3> none{Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(),
                                            Eigen::Vector2d::Zero()};
  for (const bool second : {false, true}) {
    world.mesh.add_triangle({corner[0], corner[second ? 2 : 1], corner[second ? 3 : 2]}, none,
                            kGroundTexture, world.scenario.ground.texel_m, SurfaceClass::kRoad, 1.0,
                            second);
    world.mesh.triangles.back().lift_m = static_cast<float>(lift);
  }
}

Eigen::Vector3d lifted(const Eigen::Vector2d& p, double z) { return {p.x(), p.y(), z}; }

std::array<Eigen::Vector3d, 4> level_corners(const Eigen::AlignedBox2d& area, double z) {
  using Box = Eigen::AlignedBox2d;
  return {lifted(area.corner(Box::BottomLeft), z), lifted(area.corner(Box::BottomRight), z),
          lifted(area.corner(Box::TopRight), z), lifted(area.corner(Box::TopLeft), z)};
}

// The ramp that rises from `low_z` by one storey.
void add_ramp(World& world, const StoreySpec& storeys, double low_z) {
  const Eigen::Vector2d along = (storeys.ramp_to - storeys.ramp_from).normalized();
  const Eigen::Vector2d half = 0.5 * storeys.ramp_width_m * Eigen::Vector2d(-along.y(), along.x());
  const double high_z = low_z + storeys.height_m;
  add_ground_quad(world,
                  {lifted(storeys.ramp_from - half, low_z), lifted(storeys.ramp_to - half, high_z),
                   lifted(storeys.ramp_to + half, high_z), lifted(storeys.ramp_from + half, low_z)},
                  low_z);
}

// The edge of the slab around an opening, between a ceiling and the floor over it.
void add_rim(
    World& world, const Eigen::AlignedBox2d& opening, double low_z, double high_z, int texture) {
  const auto corners = level_corners(opening, low_z);
  for (std::size_t i = 0; i < corners.size(); ++i)
    world.mesh.add_quad(corners[i], corners[(i + 1) % corners.size()] - corners[i],
                        {0.0, 0.0, high_z - low_z}, texture, kBeamTexel, SurfaceClass::kCeiling);
}

// Where beams cross the ceiling. Between equal bays they stand equally.
std::vector<double> beam_places(const Scenario& scenario) {
  constexpr double kSpacing = 5.5;
  std::vector<double> places;
  const auto& bays = scenario.bays;
  const double end = bays ? bays->low.x() + bays->count * bays->step_m() : 0.0;
  for (double x = scenario.ground.low.x() + 2.0; x < scenario.ground.high.x(); x += kSpacing)
    if (!bays || x < bays->low.x() - 1.0 || x > end + 1.0) places.push_back(x);
  for (int bay = 0; bays && bay <= bays->count; ++bay)
    places.push_back(bays->low.x() + bay * bays->step_m());
  return places;
}

void add_beam(World& world, double x, const Eigen::Vector2d& span, double z, int texture) {
  if (span.y() - span.x() < 0.1) return;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Eigen::Vector3d(x, 0.5 * (span.x() + span.y()), z - 0.35);
  world.mesh.add_box(T, {kBeamWidth, span.y() - span.x(), kBeamHeight}, texture, kBeamTexel,
                     SurfaceClass::kCeiling, 0.9);
}

}  // namespace

void add_ceilings(World& world) {
  if (!world.scenario.ceiling) return;
  const CeilingSpec& ceiling = *world.scenario.ceiling;
  const GroundSpec& spec = world.scenario.ground;
  Random random(world.scenario.seed, "ceiling");
  world.lamp_texture = static_cast<int>(world.textures.size());
  world.ceiling_m = ceiling.height_m;
  world.ceiling_low = spec.low;
  Canvas painted{paint_ceiling(ceiling, spec.low, spec.high, world.ceiling_texel_m, random),
                 spec.low, world.ceiling_texel_m};
  if (world.scenario.bays) repeat_bay(*world.scenario.bays, painted);
  world.textures.emplace_back(std::move(painted.image), false);
  // Beams give the ceiling depth.
  const int beam = static_cast<int>(world.textures.size());
  const Eigen::Vector2d size = spec.high - spec.low;
  world.textures.emplace_back(
      paint_wall(SurfaceTexture::kConcrete, size.y(), 0.4, kBeamTexel, 0, false, random), false);

  const Eigen::AlignedBox2d all(spec.low, spec.high);
  const int storeys = spec.storeys ? spec.storeys->count : 1;
  for (int storey = 0; storey < storeys; ++storey) {
    const double z = ceiling.height_m + (spec.storeys ? storey * spec.storeys->height_m : 0.0);
    const bool open = storey + 1 < storeys;
    const Eigen::AlignedBox2d ramp = open ? ramp_area(*spec.storeys) : Eigen::AlignedBox2d();
    for (const auto& part : open ? around(all, ramp) : std::vector{all}) {
      const Eigen::Vector2d sides = part.sizes();
      world.mesh.add_quad(lifted(part.min(), z), {sides.x(), 0.0, 0.0}, {0.0, sides.y(), 0.0},
                          world.lamp_texture, world.ceiling_texel_m, SurfaceClass::kCeiling, 1.0,
                          (part.min() - spec.low) / world.ceiling_texel_m);
    }
    if (open) add_rim(world, ramp, z, (storey + 1) * spec.storeys->height_m, beam);
    for (const double x : beam_places(world.scenario)) {
      const bool crosses =
          open && x + kBeamWidth > ramp.min().x() && x - kBeamWidth < ramp.max().x();
      if (!crosses) {
        add_beam(world, x, {spec.low.y(), spec.high.y()}, z, beam);
        continue;
      }
      add_beam(world, x, {spec.low.y(), ramp.min().y()}, z, beam);
      add_beam(world, x, {ramp.max().y(), spec.high.y()}, z, beam);
    }
  }
}

void add_upper_storeys(World& world) {
  const GroundSpec& spec = world.scenario.ground;
  if (!spec.storeys) return;
  const StoreySpec& storeys = *spec.storeys;
  Mesh furniture;
  furniture.surfaces = world.mesh.surfaces;
  for (const Triangle& t : world.mesh.triangles)
    if (t.texture != kGroundTexture && t.kind != SurfaceClass::kCeiling)
      furniture.triangles.push_back(t);
  const double ground = world.ground.height(spec.low.x(), spec.low.y());
  const Eigen::AlignedBox2d all(spec.low, spec.high);
  for (int storey = 0; storey < storeys.count; ++storey) {
    const double lift = storey * storeys.height_m;
    if (storey + 1 < storeys.count) add_ramp(world, storeys, ground + lift);
    if (storey == 0) continue;
    for (const auto& part : around(all, ramp_area(storeys)))
      add_ground_quad(world, level_corners(part, ground + lift), lift);
    Eigen::Isometry3d up = Eigen::Isometry3d::Identity();
    up.translation().z() = lift;
    world.mesh.add(furniture, up);
  }
}

}  // namespace roadbook
