#include "sim/world/world.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/world/path.hpp"
#include "sim/world/storeys.hpp"
#include "sim/world/surface_paint.hpp"

namespace roadbook {
namespace {

constexpr double kWallTexel = 0.012;

void add_ground(World& world) {
  // Two half planes meet in the hinge, so the ground is exact. Far beyond the painted area too,
  // because a camera sees to the horizon.
  const GroundSpec& spec = world.scenario.ground;
  const Eigen::Vector2d middle = 0.5 * (spec.low + spec.high);
  const double reach = (spec.high - spec.low).norm() + (world.scenario.ceiling ? 5.0 : 400.0);
  Eigen::Vector2d along(1.0, 0.0);
  Eigen::Vector2d centre = middle;
  if (spec.hinge) {
    along = (spec.hinge->to - spec.hinge->from).normalized();
    centre = spec.hinge->from + along * along.dot(middle - spec.hinge->from);
  }
  const Eigen::Vector2d left(-along.y(), along.x());
  const auto lift = [&](const Eigen::Vector2d& p) {
    return Eigen::Vector3d(p.x(), p.y(), world.ground.height(p.x(), p.y()));
  };
  for (const double side : {1.0, -1.0}) {
    const Eigen::Vector3d a = lift(centre - reach * along);
    const Eigen::Vector3d b = lift(centre + reach * along);
    const Eigen::Vector3d c = lift(centre + reach * along + side * reach * left);
    const Eigen::Vector3d d = lift(centre - reach * along + side * reach * left);
    const std::array<Eigen::Vector2d, 3> none{Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(),
                                              Eigen::Vector2d::Zero()};
    world.mesh.add_triangle({a, b, c}, none, kGroundTexture, spec.texel_m, SurfaceClass::kRoad, 1.0,
                            false);
    world.mesh.add_triangle({a, c, d}, none, kGroundTexture, spec.texel_m, SurfaceClass::kRoad, 1.0,
                            true);
  }
}

double lowest(const World& world, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return std::min(world.ground.height(a.x(), a.y()), world.ground.height(b.x(), b.y())) - 0.3;
}

void add_walls(World& world) {
  std::uint64_t index = 0;
  std::vector<int> look;  // texture by wall
  for (const WallSpec& wall : world.scenario.walls) {
    Random random(world.scenario.seed, "wall", index++);
    const double length = (wall.to - wall.from).norm();
    // Seen from the left of from -> to, its text reads from `to` to `from`. The foot of a wall on a
    // hinged floor is level, a little below the lowest ground.
    const double foot = world.scenario.ceiling ? 0.0 : lowest(world, wall.from, wall.to);
    const bool copy = wall.copy_of >= 0;
    const int texture = copy ? look[static_cast<std::size_t>(wall.copy_of)]
                             : static_cast<int>(world.textures.size());
    look.push_back(texture);
    if (!copy)
      world.textures.emplace_back(
          paint_wall(wall.texture, length, wall.height_m, kWallTexel, wall.posters, false, random),
          false);
    const Eigen::Vector3d origin(wall.to.x(), wall.to.y(), foot);
    const Eigen::Vector2d back = wall.from - wall.to;
    world.mesh.add_quad(origin, {back.x(), back.y(), 0.0}, {0.0, 0.0, wall.height_m}, texture,
                        kWallTexel, SurfaceClass::kWall);
  }
}

Eigen::Isometry3d upright(const Eigen::Vector2d& at, double heading, double z) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = Eigen::Vector3d(at.x(), at.y(), z);
  return T;
}

void add_blocks(World& world) {
  std::uint64_t index = 0;
  std::vector<int> look;  // texture by block
  for (const BlockSpec& block : world.scenario.blocks) {
    Random random(world.scenario.seed, "block", index++);
    const bool copy = block.copy_of >= 0;
    const int texture = copy ? look[static_cast<std::size_t>(block.copy_of)]
                             : static_cast<int>(world.textures.size());
    look.push_back(texture);
    const double wide = block.size.maxCoeff();
    const double texel = block.pillar ? 0.006 : std::max(0.02, block.height_m / 600.0);
    const double z = world.ground.height(block.at.x(), block.at.y()) - (block.pillar ? 0.0 : 0.3);
    if (!copy)
      world.textures.emplace_back(block.pillar ? paint_pillar(wide, block.height_m, texel,
                                                              static_cast<int>(index) + 100, random)
                                               : paint_wall(block.texture, wide, block.height_m,
                                                            texel, 0, block.height_m > 4.0, random),
                                  false);
    world.mesh.add_box(upright(block.at, block.heading, z),
                       {block.size.x(), block.size.y(), block.height_m}, texture, texel,
                       block.pillar ? SurfaceClass::kPillar : SurfaceClass::kBuilding);
  }
}

/// Yellow columns that stand where a line between two spaces would be.
void add_columns(World& world) {
  Random random(world.scenario.seed, "columns");
  std::vector<int> variants;
  for (int i = 0; i < 3; ++i) {
    variants.push_back(static_cast<int>(world.textures.size()));
    world.textures.emplace_back(paint_pillar(0.16, 2.9, 0.006, 10 * i + 7, random), false);
  }
  constexpr std::array<double, 3> kAlong{0.06, 0.5, 0.94};
  std::vector<std::array<std::size_t, kAlong.size()>> looks;  // variants by line
  for (const SpaceLine& line : world.layout.lines) {
    auto& look = looks.emplace_back();
    if (!line.column) continue;
    for (std::size_t i = 0; i < kAlong.size(); ++i) {
      const Eigen::Vector2d at = line.front + kAlong[i] * (line.back - line.front);
      look[i] = line.copy_of >= 0 ? looks[static_cast<std::size_t>(line.copy_of)][i]
                                  : static_cast<std::size_t>(random.below(3));
      world.mesh.add_box(upright(at, 0.0, world.ground.height(at.x(), at.y())), {0.16, 0.16, 2.9},
                         variants[look[i]], 0.006, SurfaceClass::kPillar, 1.2);
    }
  }
}

void add_cars(World& world) {
  for (std::uint64_t i = 0; i < kCarModels; ++i) {
    Random random(world.scenario.seed, "car model", i);
    world.other_cars.push_back(make_car(car_shape(static_cast<int>(i), random), SurfaceClass::kCar,
                                        world.textures, random));
  }
  for (const ParkedCar& car : world.layout.cars) {
    // The shape's origin is the rear axle; the place is that of the body's middle.
    const Eigen::Vector2d rear =
        car.centre - 1.3 * Eigen::Vector2d(std::cos(car.heading), std::sin(car.heading));
    world.mesh.add(world.other_cars[static_cast<std::size_t>(car.model)],
                   world.ground.stand(rear.x(), rear.y(), car.heading, 2.6, 1.5));
  }
  Random random(world.scenario.seed, "own car");
  world.own_car = make_car(own_car_shape(), SurfaceClass::kOwnCar, world.textures, random);
}

/// Posts, trees and signs along a road with gravel edges.
void add_roadside(World& world) {
  const Scenario& scenario = world.scenario;
  if (scenario.ground.gravel_edge_m <= 0.0) return;
  Random random(scenario.seed, "roadside");
  const int first = static_cast<int>(world.textures.size());
  world.textures.emplace_back(paint_pillar(0.15, 1.0, 0.01, 5, random), false);
  for (int i = 0; i < 3; ++i)
    world.textures.emplace_back(speckle_tile(256, 9000, 1, 7, 45.0, random), true);
  const auto stand = [&](const Eigen::Vector2d& p, double turn, const Eigen::Vector3d& size,
                         double z, int texture, double texel, double light) {
    world.mesh.add_box(upright(p, turn, world.ground.height(p.x(), p.y()) + z), size,
                       first + texture, texel, SurfaceClass::kBuilding, light);
  };
  for (const LaneSpec& lane : scenario.lanes) {
    const DrivingLine line(lane.points, scenario.vehicle.turn_radius_m, lane.closed);
    const double edge = 0.5 * lane.width_m + scenario.ground.gravel_edge_m;
    const auto beside = [&](double s, double e) {
      const double h = line.heading(s);
      return Eigen::Vector2d(line.at(s) + e * Eigen::Vector2d(-std::sin(h), std::cos(h)));
    };
    for (double s = 5.0; s < line.length_m(); s += 25.0)
      for (const double side : {-1.0, 1.0})
        stand(beside(s, side * (edge + 0.3)), line.heading(s), {0.12, 0.15, 1.0}, 0.0, 0, 0.01,
              1.2);
    for (double s = 0.0; s < line.length_m(); s += random.uniform(4.0, 14.0)) {
      const double e = (random.below(2) == 0 ? -1.0 : 1.0) * (edge + random.uniform(1.5, 14.0));
      const double tall = random.uniform(2.5, 5.0);
      const double crown = random.uniform(1.5, 3.5);
      const Eigen::Vector2d p = beside(s, e);
      const int leaves = 2 + static_cast<int>(random.below(2));
      // A bend may bring another stretch of the road here.
      if ((line.at(line.nearest(p, s, 60.0)) - p).norm() < edge + 1.0) continue;
      stand(p, s, {0.3, 0.3, tall}, -0.1, 1, 0.01, 0.45);
      stand(p, s, {crown, crown, crown}, tall - 0.8, leaves, 0.03, 0.6);
      stand(p, s + 0.8, {0.8 * crown, 0.8 * crown, 1.5 * crown}, tall - 1.0, leaves, 0.03, 0.55);
    }
  }
}

void add_cloth(World& world) {
  Random random(world.scenario.seed, "cloth");
  world.cloth_texture = static_cast<int>(world.textures.size());
  for (int i = 0; i < 16; ++i) {
    cv::Mat cloth = speckle_tile(64, 200, 2, 9, 14.0, random);
    const double tone = random.uniform(-80.0, 80.0);
    cloth.convertTo(cloth, CV_8U, 1.0, tone);
    for (int y = 0; i % 6 == 0 && y < 64; y += 16)  // some shirts are striped
      cloth.row(y).setTo(cv::saturate_cast<std::uint8_t>(128.0 - tone));
    world.textures.emplace_back(cloth, true);
  }
  world.skin_texture = static_cast<int>(world.textures.size());
  cv::Mat skin = speckle_tile(64, 60, 2, 8, 25.0, random);
  skin.convertTo(skin, CV_8U, 1.0, 40.0);
  world.textures.emplace_back(skin, true);
}

// Parked cars of the squares that have changed.
void move_cars(World& world) {
  const auto patch_of = [&](const ParkedCar& car) {
    return std::find_if(world.moved.begin(), world.moved.end(),
                        [&](const MovedPatch& m) { return m.holds(car.centre); });
  };
  std::erase_if(world.layout.cars, [&](const ParkedCar& car) {
    const auto patch = patch_of(car);
    return patch != world.moved.end() && patch->gone;
  });
  for (ParkedCar& car : world.layout.cars)
    if (const auto patch = patch_of(car); patch != world.moved.end()) car.centre += patch->shift;
}

}  // namespace

World make_world(const Scenario& scenario,
                 const GroundEffects& effects,
                 int num_threads,
                 const Progress& progress,
                 std::vector<MovedPatch> moved) {
  World world;
  world.scenario = scenario;
  world.layout = make_layout(scenario);
  world.moved = std::move(moved);
  move_cars(world);
  world.ground = Ground(scenario.ground, effects);
  const RowWork rows{num_threads, progress};
  world.paint = paint_ground(scenario, world.layout, rows);
  move_content(world.moved, world.paint.brightness);
  move_content(world.moved, world.paint.kind);
  pave(world.moved, scenario.ground, world.paint.brightness);
  clear_kinds(world.moved, static_cast<std::uint8_t>(SurfaceClass::kRoad), world.paint.kind);
  world.ground_texture = Texture(world.paint.brightness.image, false);
  world.paint.brightness.image.release();  // the texture has it
  Random stones(scenario.seed, "stones");
  world.fine_stones = Texture(speckle_tile(1024, 60000, 1, 4, 20.0, stones), true);
  world.coarse_stones = Texture(speckle_tile(1024, 30000, 1, 5, 16.0, stones), true);
  for (const auto add : {add_ground, add_walls, add_blocks, add_columns, add_ceilings, add_cars,
                         add_upper_storeys, add_cloth, add_roadside}) {
    report(progress, "world", 0, 1);
    add(world);
  }
  report(progress, "world", 0, 1);
  Random sky(scenario.seed, "sky");
  world.sky = Texture(paint_sky(sky), true);
  return world;
}

}  // namespace roadbook
