#include "sim/streams/range_stream.hpp"

#include <algorithm>
#include <cmath>

#include "base/random.hpp"
#include "sensors/stream_noise.hpp"
#include "sim/render/ray_scene.hpp"

namespace roadbook {
namespace {

// Distances along the beams [m]; the sensor's maximum where nothing is nearer.
std::vector<double> cast(const RayScene& still,
                         const RayScene& moving,
                         const RangeModel& model,
                         const Eigen::Isometry3d& T_world_sensor) {
  std::vector<double> ranges;
  const Eigen::Vector3f origin = T_world_sensor.translation().cast<float>();
  for (std::size_t first = 0; first < model.azimuth_rad.size(); first += RayBatch::kMost) {
    RayBatch rays;
    rays.count = std::min(RayBatch::kMost, model.azimuth_rad.size() - first);
    rays.origin = {origin.x(), origin.y(), origin.z()};
    for (std::size_t i = 0; i < rays.count; ++i) {
      const double a = model.azimuth_rad[first + i];
      const Eigen::Vector3d along(std::cos(a), std::sin(a), 0.0);
      rays.set_direction(i, (T_world_sensor.linear() * along).cast<float>());
    }
    rays.clear_ends();
    still.intersect(rays);
    moving.intersect(rays);
    for (std::size_t i = 0; i < rays.count; ++i) {
      const bool met = rays.triangle[i] != nullptr;
      const double range = static_cast<double>(rays.range_m[i]);
      ranges.push_back(met ? std::min(range, model.max_m) : model.max_m);
    }
  }
  return ranges;
}

}  // namespace

void simulate_ranges(const World& world,
                     const VehicleMotion& drive,
                     const Pedestrians& people,
                     const RangeModel& model,
                     std::int64_t start_ns,
                     double end_s,
                     const StreamOptions& options,
                     const std::function<void(const RangeReading&)>& visit) {
  constexpr double kInterval = 0.1;  // [s]
  const BeamMixture mixture = beam_mixture(options.effects);
  RayScene still;
  RayScene moving;
  still.set(world.mesh.triangles, true);
  Random random(options.seed, "range");
  std::vector<StreamNoise> noise(model.azimuth_rad.size(), StreamNoise(options.effects, "range0"));
  for (int k = 0; kInterval * k <= end_s; ++k) {
    const double t = kInterval * k;
    moving.set(moving_mesh(world, people, t).triangles);
    const VehicleState s = drive.at(t);
    const std::vector<double> expected =
        cast(still, moving, model, drive.T_world_vehicle(t) * model.T_vehicle_sensor);
    RangeReading reading;
    reading.t_ns = start_ns + static_cast<std::int64_t>(std::llround(t * 1e9));
    for (std::size_t beam = 0; beam < expected.size(); ++beam) {
      const double part = random.uniform();
      const double within = random.uniform();
      const double normal = options.noise ? noise[beam].next(random, s.speed, s.yaw_rate) : 0.0;
      reading.beam = static_cast<std::int64_t>(beam);
      reading.range_m = predict_range(model, mixture, expected[beam], part, within, normal);
      visit(reading);
    }
  }
}

}  // namespace roadbook
