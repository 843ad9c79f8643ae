#include "mapping/pipeline/drive_steps.hpp"

#include "mapping/pipeline/map_paths.hpp"
#include "mapping/pipeline/odometry_checkpoint.hpp"
#include "vo/exposure_shift.hpp"
#include "vo/track_drive.hpp"

namespace roadbook {

std::vector<Drive> open_drives(const std::vector<std::filesystem::path>& folders,
                               const EffectSizes& model) {
  std::vector<Drive> opened;
  for (const auto& folder : folders) {
    opened.push_back(Drive::open(folder));
    if (!model.empty()) opened.back().correct(model);
  }
  return opened;
}

VoResult odometry_of(const Drive& drive,
                     const OwnCar& car,
                     std::size_t index,
                     const MapOptions& options,
                     MapFileBuilder& build,
                     const Progress& progress) {
  const std::string stage = odometry_stage(index);
  if (build.has(stage)) {
    VoResult odometry = load_odometry(stage, build);
    move_to_stamps(half_size(drive.rig()), odometry);
    return odometry;
  }
  TrackDriveOptions tracking = options.tracking;
  tracking.num_threads = options.num_threads;
  VoResult odometry = track_drive(drive, car.masks, tracking, progress);
  if (static_cast<int>(odometry.keyframes.size()) < options.min_keyframes)
    throw Refused("error: " + drive.folder().string() + ": keyframes: got " +
                  std::to_string(odometry.keyframes.size()) + ", want at least " +
                  std::to_string(options.min_keyframes) + " (does the car move?)");
  save_odometry(odometry, stage, build);
  move_to_stamps(half_size(drive.rig()), odometry);
  return odometry;
}

void add_doubts(const Drive& drive, const VoResult& odometry, std::vector<Problem>& warnings) {
  for (const SensorDoubt& doubt : odometry.doubts)
    warnings.push_back(
        {Severity::kWarning,
         (doubt.sensor.empty() ? drive.folder() : drive.folder() / doubt.sensor).string(), 0,
         "motion", doubt.got, doubt.want});
}

Problem short_segments_warning(const Drive& drive, int keyframes) {
  return {Severity::kWarning,
          drive.folder().string(),
          0,
          "keyframes",
          std::to_string(keyframes) + " between gaps, too few to be placed; they are left out",
          "images without gaps"};
}

std::vector<CameraDoubt> judge_cameras(const MappingInput& input,
                                       const std::vector<Drive>& drives,
                                       const Adjusted& adjusted,
                                       const GateInputs& gate,
                                       const MapOptions& options,
                                       MapSummary& summary) {
  summary.cameras = camera_figures(input, drives, adjusted.stage, adjusted.result);
  CameraDoubtOptions doubt;
  doubt.num_threads = options.num_threads;
  auto found = doubt_cameras(input, adjusted.T_map_vehicle, doubt);
  const auto doubts = to_problems(found, drives);
  const auto idle = warnings_of_idle_cameras(summary.cameras, input, gate, options.gate);
  summary.warnings.insert(summary.warnings.end(), idle.begin(), idle.end());
  summary.warnings.insert(summary.warnings.end(), doubts.begin(), doubts.end());
  require_evidence(input, adjusted, summary.cameras, doubts, gate, options.gate);
  require_possible_motions(input, adjusted.T_map_vehicle, gate);
  return found;
}

Session session_of(const Drive& drive,
                   const OwnCar& car,
                   const MapOptions& options,
                   const std::filesystem::path& map) {
  Session session;
  session.name = options.session_name.empty() ? drive.name() : options.session_name;
  session.drive_path = path_from_map(drive.folder(), map);
  session.drive_digest = drive.digest();
  session.rig = drive.rig();
  session.wheels = drive.wheel_model();
  // Also measures that give no body, because the width alone is useful.
  session.vehicle =
      options.vehicle ? *options.vehicle : drive.vehicle().value_or(VehicleMeasures{});
  session.vehicle_source = car.source;
  session.t_begin_ns = drive.frame_stamp_ns(0);
  session.t_end_ns = drive.frame_stamp_ns(drive.frame_count() - 1);
  return session;
}

void set_scale(const Adjusted& adjusted,
               std::size_t index,
               const std::optional<double>& ground_sigma,
               Session& session) {
  const int scale = adjusted.stage.scale_of_session[index];
  if (scale >= 0) {
    session.scale_source = ScaleSource::kWheels;
    session.wheel_scale = adjusted.stage.problem.scales[static_cast<std::size_t>(scale)].value;
    if (adjusted.covariance.usable)
      session.wheel_scale_sigma = adjusted.covariance.scale_sigmas[static_cast<std::size_t>(scale)];
    session.scale_sigma = session.wheel_scale_sigma;
  } else if (ground_sigma) {
    session.scale_source = ScaleSource::kCameraHeight;
    session.scale_sigma = *ground_sigma;
  }
}

}  // namespace roadbook
