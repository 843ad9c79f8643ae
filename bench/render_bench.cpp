#include <benchmark/benchmark.h>

#include <string>

#include "sim/render/image_sensor.hpp"
#include "sim/render/renderer.hpp"
#include "sim/simulate.hpp"
#include "sim/streams/rig.hpp"
#include "sim/world/moving.hpp"
#include "sim/world/path.hpp"
#include "sim/world/vehicle.hpp"
#include "sim/world/world.hpp"

// Measures the CPU time of one instant of four cameras, 1280x960, with image noise, without PNG.
// The limit is 0.4 s. With one thread, wall time is CPU time.

namespace roadbook {
namespace {

void render_four_cameras(benchmark::State& state, const std::string& place) {
  const Scenario scenario = load_scenario(place);
  const World world = make_world(scenario, {}, 0);
  const Rig rig = make_rig(scenario.cameras);
  std::vector<Camera> cameras;
  std::vector<Eigen::Isometry3d> mounts;
  for (const auto& mount : rig.cameras) {
    cameras.push_back(mount.camera);
    mounts.push_back(mount.T_vehicle_camera);
  }
  RenderOptions options;
  options.num_threads = 1;
  const Renderer renderer(world, cameras, mounts, options);
  const DrivingLine line = route_line(scenario, scenario.route);
  std::uint64_t frame = 0;
  for (auto _ : state) {
    const double s = 10.0 + 3.7 * static_cast<double>(frame);
    const Eigen::Vector2d p = line.at(s);
    const Eigen::Isometry3d T_world_vehicle =
        world.ground.stand(p.x(), p.y(), line.heading(s), 2.6, 1.5);
    for (std::size_t c = 0; c < cameras.size(); ++c) {
      const View view = renderer.render(c, {T_world_vehicle * mounts[c]});
      benchmark::DoNotOptimize(develop(view.brightness, {}, 1, frame, c, 1));
    }
    ++frame;
  }
}

BENCHMARK_CAPTURE(render_four_cameras, zurich, "zurich")->Iterations(8)->Unit(benchmark::kSecond);
BENCHMARK_CAPTURE(render_four_cameras, stuttgart, "stuttgart")
    ->Iterations(8)
    ->Unit(benchmark::kSecond);
BENCHMARK_CAPTURE(render_four_cameras, road, "road")->Iterations(8)->Unit(benchmark::kSecond);

void make_place(benchmark::State& state, const std::string& place) {
  const Scenario scenario = load_scenario(place);
  for (auto _ : state) benchmark::DoNotOptimize(make_world(scenario, {}, 0).mesh.triangles.size());
}

BENCHMARK_CAPTURE(make_place, zurich, "zurich")->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
}  // namespace roadbook
