#include "sim/simulate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "base/error.hpp"
#include "base/files/disk_space.hpp"
#include "base/parallel.hpp"
#include "drive/writer.hpp"
#include "sensors/pose_imperfections.hpp"
#include "sim/render/image_sensor.hpp"
#include "sim/render/renderer.hpp"
#include "sim/streams/detector_stream.hpp"
#include "sim/streams/friction_stream.hpp"
#include "sim/streams/range_stream.hpp"
#include "sim/streams/rig.hpp"
#include "sim/streams/sensor_streams.hpp"
#include "sim/truth.hpp"
#include "sim/useful_effects.hpp"
#include "sim/world/moving.hpp"
#include "sim/world/path.hpp"
#include "sim/world/vehicle.hpp"
#include "sim/world/world.hpp"

namespace roadbook {
namespace {

double thread_cpu_s() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

GroundEffects ground_effects(const EffectSizes& effects) {
  GroundEffects ground;
  ground.height_m = effect_size(effects, "ground", "height");
  ground.hinge = effect_size(effects, "ground", "hinge");
  return ground;
}

/// Everything about one drive that is decided before the first image.
struct Recording {
  World world;
  Rig rig;
  std::vector<RealCamera> cameras;
  VehicleMotion drive;
  Pedestrians people;
  double duration_s;
  std::int64_t start_ns;
};

VehicleMotion plan_drive(const Scenario& scenario,
                         const Ground& ground,
                         const SimulateOptions& options) {
  Random driver(options.seed, "driver", static_cast<std::uint64_t>(scenario.visit));
  DriverOptions driving;
  driving.wander = options.noise;
  driving.lateral_slip_per_sqrt_m =
      options.noise ? nominal_wheels(scenario.vehicle).sigma_lateral_per_sqrt_m : 0.0;
  // `ground.slope`: the ground rises forward of a car that hangs its nose by as much.
  VehicleSpec vehicle = scenario.vehicle;
  vehicle.nose_down_rad = effect_size(options.effects, "ground", "slope");
  return drive_line(route_line(scenario, scenario.route),
                    scenario.laps[static_cast<std::size_t>(scenario.visit)], scenario.stops,
                    vehicle, ground, driving, driver);
}

Recording prepare(const Scenario& scenario,
                  const SimulateOptions& options,
                  const Progress& progress) {
  World world = make_world(scenario, ground_effects(options.effects), options.num_threads, progress,
                           changed_patches(scenario, options.effects, options.seed));
  // `ground.height` lifts the ground towards a car whose springs give as much: the car's own pose
  // stays where it would be without.
  GroundEffects stood_on = ground_effects(options.effects);
  stood_on.height_m = 0.0;
  VehicleMotion drive = plan_drive(scenario, Ground(scenario.ground, stood_on), options);
  Pedestrians people(scenario, drive, options.seed);
  Rig rig = make_rig(scenario.cameras);
  std::vector<RealCamera> cameras;
  for (const auto& camera : rig.cameras) cameras.push_back(real_camera(camera, options.effects));
  double duration = drive.duration_s();
  if (options.max_duration_s > 0.0) duration = std::min(duration, options.max_duration_s);
  return {std::move(world),
          std::move(rig),
          std::move(cameras),
          std::move(drive),
          std::move(people),
          duration,
          drive_start_ns(scenario.visit)};
}

/// World poses of a camera for an image stamped t: one, or one a row.
std::vector<Eigen::Isometry3d> camera_poses(const Recording& recording,
                                            const RealCamera& real,
                                            double t_s) {
  const double seen = t_s - real.latency_s;
  if (real.rolling_shutter_s == 0.0)
    return {recording.drive.T_world_vehicle(seen) * real.T_vehicle_camera};
  std::vector<Eigen::Isometry3d> poses;
  const int rows = real.camera.height;
  for (int y = 0; y < rows; ++y) {
    const double share = (y + 0.5) / rows - 0.5;
    poses.push_back(recording.drive.T_world_vehicle(seen + share * real.rolling_shutter_s) *
                    real.T_vehicle_camera);
  }
  return poses;
}

void write_range(const std::filesystem::path& out,
                 const std::string& camera,
                 std::int64_t t_ns,
                 const cv::Mat& range_m) {
  const auto folder = out / "truth" / "range" / camera;
  std::filesystem::create_directories(folder);
  cv::Mat millimetres;
  range_m.convertTo(millimetres, CV_16U, 1000.0);
  const auto file = folder / (std::to_string(t_ns) + ".png");
  if (!cv::imwrite(file.string(), millimetres))
    throw StorageError("error: " + file.string() + ": writing: got " + write_fault(file) +
                       ", want a disk that takes it");
}

// The reference poses are the poses that a map gives. A map that is scaled or bent makes them wrong
// by as much; the truth holds the car's true poses.
void write_reference(const std::vector<TimedPose>& truth,
                     const EffectSizes& effects,
                     DriveWriter& writer) {
  PoseImperfections<double> off;
  off.scale = effect_size(effects, "map", "scale");
  off.bend = effect_size(effects, "map", "bend");
  if (off.scale == 0.0 && off.bend == 0.0) {
    writer.write_truth(truth);
    return;
  }
  std::vector<TimedPose> reference = truth;
  for (TimedPose& pose : reference)
    pose.T_world_vehicle = predict_pose(off, pose.T_world_vehicle, truth.front().T_world_vehicle);
  writer.write_truth(reference);
  writer.write_true_poses(truth);
}

std::int64_t last_stamp(const Recording& recording) {
  return recording.start_ns + static_cast<std::int64_t>(recording.duration_s * 1e9);
}

void write_streams(const Recording& recording,
                   const std::filesystem::path& out,
                   const SimulateOptions& options,
                   const std::vector<std::int64_t>& frames,
                   DriveWriter& writer) {
  const StreamOptions streams{options.seed, options.noise, options.effects};
  const std::int64_t last = last_stamp(recording);
  for (const auto& reading :
       simulate_wheels(recording.world, recording.drive, recording.start_ns, streams))
    if (reading.t_ns <= last) writer.write_wheels(reading);
  if (recording.world.scenario.imu)
    for (const auto& reading : simulate_imu(recording.drive, recording.start_ns, streams))
      if (reading.t_ns <= last) writer.write_imu(reading);
  if (recording.world.scenario.friction)
    for (const auto& reading : simulate_friction(
             recording.world, recording.drive, recording.start_ns, streams,
             options.temperature || has_effects_of(options.effects, "friction0.temperature")))
      if (reading.t_ns <= last) writer.write_friction(reading);
  if (options.ranges || has_effects_of(options.effects, "range0.")) {
    const RangeModel model = nominal_range_model();
    writer.set_range_model(model);
    simulate_ranges(recording.world, recording.drive, recording.people, model, recording.start_ns,
                    recording.duration_s, streams,
                    [&](const RangeReading& reading) { writer.write_range(reading); });
  }
  if (options.detections || has_effects_of(options.effects, "detector.")) {
    const SimulatedDetections made =
        simulate_detections(recording.world, recording.drive, recording.people, recording.rig, {},
                            recording.start_ns, recording.duration_s, streams);
    write_detections(detector_folder(out), made.detections, made.looks);
  }
  std::vector<TimedPose> truth;
  for (const std::int64_t t_ns : frames)
    truth.push_back({t_ns, recording.drive.T_world_vehicle(
                               1e-9 * static_cast<double>(t_ns - recording.start_ns))});
  write_reference(truth, options.effects, writer);
}

bool alive(const SimulateOptions& options, const std::string& camera, double t_s) {
  const auto end = options.camera_dies_s.find(camera);
  return end == options.camera_dies_s.end() || t_s < end->second;
}

void write_images(const Recording& recording,
                  const std::filesystem::path& out,
                  const SimulateOptions& options,
                  const std::vector<std::int64_t>& frames,
                  DriveWriter& writer,
                  const Progress& progress,
                  SimulationSummary& summary) {
  const std::size_t cameras = recording.cameras.size();
  const int threads = thread_count(options.num_threads);
  RenderOptions render;
  render.kinds = options.class_images;
  render.ranges = options.range_images;
  // One thread a camera; the remaining threads work inside the images.
  render.num_threads = std::max(1, threads / static_cast<int>(cameras));
  std::vector<Camera> lenses;
  std::vector<Eigen::Isometry3d> mounts;
  for (const auto& real : recording.cameras) {
    lenses.push_back(real.camera);
    mounts.push_back(real.T_vehicle_camera);
  }
  Renderer renderer(recording.world, lenses, mounts, render);
  std::vector<double> cpu_s(cameras, 0.0);
  for (std::size_t frame = 0; frame < frames.size(); ++frame) {
    report(progress, "render", frame, frames.size());
    const double t = 1e-9 * static_cast<double>(frames[frame] - recording.start_ns);
    renderer.set_moving(moving_mesh(recording.world, recording.people, t));
    parallel_for(cameras, threads, [&](std::size_t c) {
      const RealCamera& real = recording.cameras[c];
      const std::string& name = recording.rig.cameras[c].name;
      if (!alive(options, name, t)) return;
      const double before = thread_cpu_s();
      const View view = renderer.render(c, camera_poses(recording, real, t));
      ImageSensorOptions sensor;
      sensor.noise = options.noise;
      sensor.gain = real.gain * (t < 0.5 * recording.duration_s ? 1.0 : real.later_gain);
      sensor.vignetting = real.vignetting;
      const cv::Mat grey =
          develop(view.brightness, sensor,
                  options.seed + static_cast<std::uint64_t>(recording.world.scenario.visit), frame,
                  c, render.num_threads);
      cpu_s[c] += thread_cpu_s() - before;
      writer.write_image(c, frames[frame], grey);
      if (options.class_images) writer.write_segmentation(c, frames[frame], view.kind);
      if (options.range_images) write_range(out, name, frames[frame], view.range_m);
    });
    for (const auto& camera : recording.rig.cameras)
      summary.images += alive(options, camera.name, t) ? 1U : 0U;
  }
  report(progress, "render", frames.size(), frames.size());
  for (const double s : cpu_s) summary.render_cpu_s += s;
}

}  // namespace

SimulationSummary simulate(const Scenario& scenario,
                           const std::filesystem::path& out,
                           const SimulateOptions& options,
                           const Progress& progress) {
  options.check();
  refuse_effects_without_use(scenario, options);
  report(progress, "world", 0, 1);
  const Recording recording = prepare(scenario, options, progress);
  report(progress, "world", 1, 1);
  refuse_effects_without_change(recording.world, recording.drive, recording.start_ns,
                                last_stamp(recording),
                                {options.seed, options.noise, options.effects});
  DriveWriterOptions writing;
  writing.overwrite = options.overwrite;
  writing.comment = "simulated: " + scenario.name + ", visit " + std::to_string(scenario.visit);
  writing.camera_rate_hz = scenario.cameras.rate_hz;
  writing.wheel_rate_hz = 50.0;
  DriveWriter writer(out, options.images ? recording.rig : Rig{}, nominal_wheels(scenario.vehicle),
                     writing);
  writer.write_vehicle(vehicle_measures(scenario.vehicle));
  std::vector<std::int64_t> frames;
  for (std::size_t k = 0; static_cast<double>(k) / scenario.cameras.rate_hz <= recording.duration_s;
       ++k)
    frames.push_back(recording.start_ns +
                     std::llround(1e9 * static_cast<double>(k) / scenario.cameras.rate_hz));
  SimulationSummary summary;
  summary.frames = frames.size();
  summary.duration_s = recording.duration_s;
  summary.distance_m = recording.drive.at(recording.duration_s).distance_m;
  summary.parked_cars = recording.world.layout.cars.size();
  summary.pedestrians = recording.people.count();
  write_streams(recording, out, options, frames, writer);
  if (options.images) write_images(recording, out, options, frames, writer, progress, summary);
  write_truth_folder(out, recording.world, recording.people, recording.drive, options.effects,
                     options.seed, recording.duration_s);
  writer.finish();
  return summary;
}

}  // namespace roadbook
