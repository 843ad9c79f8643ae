#include "apps/evaluation/people_scene.hpp"

#include <array>
#include <cmath>

#include "base/parallel.hpp"
#include "sim/render/image_sensor.hpp"
#include "sim/render/renderer.hpp"
#include "sim/streams/rig.hpp"
#include "sim/streams/sensor_streams.hpp"
#include "sim/world/path.hpp"

namespace roadbook {
namespace {

constexpr double kClear = 0.75;    // least visible share of a person that must be found
constexpr double kNothing = 0.15;  // at or below this share, a person cannot be found

VehicleMotion plan(const Scenario& scenario, std::uint64_t seed) {
  Random driver(seed, "driver", static_cast<std::uint64_t>(scenario.visit));
  return drive_line(route_line(scenario, scenario.route),
                    scenario.laps[static_cast<std::size_t>(scenario.visit)], scenario.stops,
                    scenario.vehicle, Ground(scenario.ground), {}, driver);
}

// Returns the share of the line from feet to crown on which the image shows a person at that
// distance.
double seen_share(const View& view,
                  const MountedCamera& mounted,
                  const Eigen::Vector3d& foot_vehicle,
                  double height_m) {
  constexpr int kPoints = 12;
  int seen = 0;
  for (int i = 0; i < kPoints; ++i) {
    const Eigen::Vector3d p =
        mounted.T_vehicle_camera.inverse() *
        (foot_vehicle + Eigen::Vector3d(0.0, 0.0, height_m * (i + 0.5) / kPoints));
    const auto pixel = mounted.camera.project(p);
    if (!pixel || !mounted.camera.contains(*pixel, 1.0)) continue;
    const int u = static_cast<int>(std::lround(pixel->x()));
    const int v = static_cast<int>(std::lround(pixel->y()));
    // The background is visible between the legs, so pixels a little to each side count too.
    const int reach = 1 + static_cast<int>(0.12 * mounted.camera.focal_px() / p.norm());
    for (int du = -reach; du <= reach; ++du) {
      if (u + du < 0 || u + du >= view.kind.cols) continue;
      const bool person = view.kind.at<unsigned char>(v, u + du) ==
                          static_cast<unsigned char>(SurfaceClass::kPedestrian);
      if (!person || std::abs(view.range_m.at<float>(v, u + du) - p.norm()) > 0.6) continue;
      ++seen;
      break;
    }
  }
  return static_cast<double>(seen) / kPoints;
}

}  // namespace

struct PeopleScene::Impl {
  Scenario scenario;
  World world;
  Rig rig;
  VehicleMotion drive;
  Pedestrians people;
  std::uint64_t seed;
  int num_threads;
  std::unique_ptr<Renderer> renderer;
  std::vector<PersonCamera> cameras;
};

PeopleScene::PeopleScene(const std::string& place,
                         const ScenarioOptions& options,
                         std::uint64_t seed,
                         int num_threads) {
  const Scenario scenario = load_scenario(place, options);
  VehicleMotion drive = plan(scenario, seed);
  Pedestrians people(scenario, drive, seed);
  impl_ = std::make_unique<Impl>(Impl{scenario,
                                      make_world(scenario, {}, num_threads),
                                      make_rig(scenario.cameras),
                                      std::move(drive),
                                      std::move(people),
                                      seed,
                                      num_threads,
                                      nullptr,
                                      {}});
  std::vector<Camera> lenses;
  std::vector<Eigen::Isometry3d> mounts;
  for (const MountedCamera& mounted : impl_->rig.cameras) {
    lenses.push_back(mounted.camera);
    mounts.push_back(mounted.T_vehicle_camera);
  }
  RenderOptions render;
  render.kinds = render.ranges = true;
  render.num_threads = 1;
  impl_->renderer = std::make_unique<Renderer>(impl_->world, lenses, mounts, render);
  for (std::size_t c = 0; c < lenses.size(); ++c)
    impl_->cameras.emplace_back(impl_->rig.cameras[c], 255 - impl_->renderer->own_car_mask(c));
}

PeopleScene::~PeopleScene() = default;

double PeopleScene::duration_s() const { return impl_->drive.duration_s(); }
const std::vector<PersonCamera>& PeopleScene::cameras() const { return impl_->cameras; }

GroundModel PeopleScene::ground() const {
  std::vector<GroundPoint> points;
  std::vector<Eigen::Vector2d> around;
  for (double t = 0.0; t < duration_s(); t += 1.0) {
    const Eigen::Vector2d p = impl_->drive.T_world_vehicle(t).translation().head<2>();
    around.push_back(p);
    for (int x = -12; x <= 12; x += 2)
      for (int y = -12; y <= 12; y += 2) {
        const Eigen::Vector2d q = (p + Eigen::Vector2d(x, y)).array().round();
        points.push_back({{q.x(), q.y(), impl_->world.ground.height(q.x(), q.y())}, 0.02});
      }
  }
  return GroundModel::fit(points, around);
}

PeopleScene::Instant PeopleScene::at(double t_s, double range_m) const {
  Instant instant;
  instant.T_world_vehicle = impl_->drive.T_world_vehicle(t_s);
  impl_->renderer->set_moving(moving_mesh(impl_->world, impl_->people, t_s));
  const std::size_t cameras = impl_->rig.cameras.size();
  std::vector<View> views(cameras);
  instant.frame.images.resize(cameras);
  parallel_for(cameras, impl_->num_threads, [&](std::size_t c) {
    views[c] = impl_->renderer->render(
        c, {instant.T_world_vehicle * impl_->rig.cameras[c].T_vehicle_camera});
    instant.frame.images[c] = image_pyramid(develop(
        views[c].brightness, {}, impl_->seed + static_cast<std::uint64_t>(impl_->scenario.visit),
        static_cast<std::uint64_t>(std::lround(1e3 * t_s)), c, 1));
  });
  for (std::size_t i = 0; i < impl_->people.count(); ++i) {
    const PersonState state = impl_->people.at(i, t_s);
    const Eigen::Vector3d foot =
        instant.T_world_vehicle.inverse() *
        Eigen::Vector3d(state.x, state.y, impl_->world.ground.height(state.x, state.y));
    instant.there.feet.emplace_back(foot.head<2>());
    for (std::size_t c = 0; c < cameras; ++c) {
      const MountedCamera& mounted = impl_->rig.cameras[c];
      const double far_m = (foot - mounted.T_vehicle_camera.translation()).head<2>().norm();
      const double share = seen_share(views[c], mounted, foot, impl_->people.height_m(i));
      if (far_m > kListedRange * range_m || share < kNothing) continue;
      instant.there.people.push_back(
          {box_of_person(static_cast<int>(c), mounted, foot, impl_->people.height_m(i)),
           far_m <= range_m && far_m >= 1.5 && share >= kClear});
      instant.there.who.push_back(static_cast<int>(i));
    }
  }
  return instant;
}

}  // namespace roadbook
