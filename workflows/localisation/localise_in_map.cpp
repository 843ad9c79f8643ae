#include "workflows/localisation/localise_in_map.hpp"

#include <algorithm>
#include <utility>

#include "base/format.hpp"
#include "base/whole_file.hpp"
#include "drive/true_poses.hpp"
#include "drive/vehicle_yaml.hpp"
#include "mapping/landmark_weights.hpp"
#include "mapping/pieces.hpp"
#include "mapping/store/map_file.hpp"
#include "mapping/store/map_reading.hpp"
#include "vo/own_car_mask.hpp"
#include "workflows/localisation/localisation_files.hpp"
#include "workflows/localisation/world_in_map.hpp"
#include "workflows/settings/effect_model.hpp"

namespace roadbook {
namespace {

Drive open_corrected(const LocaliseRequest& request) {
  Drive drive = Drive::open(request.drive);
  if (!request.model.empty()) drive.correct(read_effect_model(request.model));
  return drive;
}

void require_landmarks(const Map& map, const std::filesystem::path& file) {
  if (map.landmarks.empty())
    throw BadInput({Severity::kError, file.string(), 0, "landmarks", "none",
                    "a map with landmarks (roadbook map)"});
}

// Whether the cameras have the same models, image sizes and places on the vehicle.
bool has_same_cameras(const Rig& a, const Rig& b) {
  constexpr double kApartM = 0.1;
  constexpr double kApartRad = 0.1;
  return std::equal(
      a.cameras.begin(), a.cameras.end(), b.cameras.begin(), b.cameras.end(),
      [&](const MountedCamera& one, const MountedCamera& other) {
        const Eigen::Isometry3d T = one.T_vehicle_camera.inverse() * other.T_vehicle_camera;
        return one.camera.model == other.camera.model && one.camera.width == other.camera.width &&
               one.camera.height == other.camera.height && T.translation().norm() < kApartM &&
               so3_log(T.linear()).norm() < kApartRad;
      });
}

std::string cameras_text(const Rig& rig) {
  const Camera& first = rig.cameras.front().camera;
  return std::to_string(rig.cameras.size()) + " of " + std::to_string(first.width) + " x " +
         std::to_string(first.height);
}

// Warnings about this drive in this map.
std::vector<Problem> doubts_about(const Drive& drive, const Map& map, const std::string& digest) {
  std::vector<Problem> doubts;
  for (const Session& session : map.sessions)
    if (session.drive_digest == digest)
      doubts.push_back({Severity::kWarning, drive.folder().string(), 0, "drive",
                        "session " + session.name + " of the map itself",
                        "a drive that the map does not have (the figures are too good)"});
  for (const MountedCamera& camera : drive.rig().cameras)
    if (camera.rolling_shutter_s != 0.0)
      doubts.push_back({Severity::kWarning, (drive.folder() / camera.name).string(), 0,
                        "rolling_shutter", fixed(1e3 * camera.rolling_shutter_s, 1) + " ms",
                        "0 ms: a localisation does not correct it"});
  const bool has_equal_rig = std::any_of(
      map.sessions.begin(), map.sessions.end(),
      [&](const Session& session) { return has_same_cameras(session.rig, drive.rig()); });
  if (!has_equal_rig)
    doubts.push_back({Severity::kWarning, drive.folder().string(), 0, "cameras",
                      cameras_text(drive.rig()),
                      cameras_text(map.sessions.front().rig) +
                          " at the same places, as the map (other views match less)"});
  return doubts;
}

std::optional<Refused> refusal_of(const LocaliseRequest& request,
                                  const LocalisationFigures& figures) {
  const double share = figures.frames > 0 ? static_cast<double>(figures.localised) /
                                                static_cast<double>(figures.frames)
                                          : 0.0;
  const std::string line = "error: " + request.map.string() + ": " + request.drive.string() +
                           ": got " + std::to_string(figures.localised) + " of " +
                           std::to_string(figures.frames) + " frames localised, want ";
  if (figures.localised == 0) return Refused(line + "a drive of this place");
  if (request.want && share < *request.want)
    return Refused(line + fixed(100.0 * *request.want, 1) + " % of them (--want)");
  return std::nullopt;
}

}  // namespace

LocaliseResult localise_in_map(const LocaliseRequest& request, Messages& messages) {
  LocaliseResult result;
  const Drive drive = open_corrected(request);
  if (drive.rig().cameras.empty())
    throw BadInput(
        {Severity::kError, drive.folder().string(), 0, "cameras", "none", "at least one camera"});
  const MapReading reading(request.map);
  const Map map = load_joined_map(request.map);
  result.map_digest = load_meta(request.map).digest;
  reading.require_same_map();
  require_landmarks(map, request.map);
  result.warnings = doubts_about(drive, map, drive.digest());
  const LandmarkIndex index(map, request.sessions, kLeastWeight);
  for (const Session& session : map.sessions)
    if (request.sessions.empty() ||
        std::count(request.sessions.begin(), request.sessions.end(), session.name) > 0)
      result.sessions_used.push_back(session.name);
  std::optional<VehicleMeasures> vehicle;
  if (!request.vehicle.empty()) vehicle = load_vehicle(request.vehicle);
  const OwnCar car = find_own_car(drive, vehicle, request.options.tracking.num_threads);
  result.frames = localise_drive(drive, car.masks, index, request.options, messages.progress());
  const auto warnings = drive.warnings();
  result.warnings.insert(result.warnings.end(), warnings.begin(), warnings.end());
  result.figures = localisation_figures(result.frames);
  for (std::size_t k = 0; k < map.keyframes.size(); ++k)
    result.map_places.emplace_back(map.T_map_vehicle(static_cast<int>(k)).translation().head<2>());
  if (const auto T_map_world = world_in_map(request.map, map, drive)) {
    const auto truth = true_poses(drive);
    result.figures.truth = localisation_truth(result.frames, truth, *T_map_world);
    result.off_m = localisation_errors(result.frames, truth, *T_map_world);
  }
  if (!request.poses.empty())
    write_whole_file(request.poses, localised_tum(result.frames, request.with_predicted));
  if (!request.frames.empty()) write_whole_file(request.frames, localised_csv(result.frames, map));
  result.refusal = refusal_of(request, result.figures);
  return result;
}

}  // namespace roadbook
