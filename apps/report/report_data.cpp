#include "apps/report/report_data.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/report/label_section.hpp"
#include "apps/report/pictures.hpp"
#include "apps/report/speed_section.hpp"
#include "base/format.hpp"
#include "drive/drive.hpp"
#include "drive/true_poses.hpp"
#include "workflows/drive_images.hpp"
#include "workflows/driven_passes.hpp"
#include "workflows/session_drives.hpp"
#include "workflows/stored_network.hpp"

namespace roadbook {
namespace {

constexpr std::int64_t kTruthToleranceNs = 5'000'000;

void count_observations(ReportData& data) {
  const Map& map = data.map;
  data.observations_of_keyframe.assign(map.keyframes.size(), 0);
  data.views_of_landmark.assign(map.landmarks.size(), 0);
  for (const Observation& seen : map.observations) {
    const auto keyframe = static_cast<std::size_t>(seen.keyframe);
    const auto landmark = static_cast<std::size_t>(seen.landmark);
    ++data.observations_of_keyframe[keyframe];
    ++data.views_of_landmark[landmark];
    const Session& session =
        map.sessions[static_cast<std::size_t>(map.keyframes[keyframe].session)];
    const MountedCamera& camera = session.rig.cameras[static_cast<std::size_t>(seen.camera)];
    const Eigen::Vector3d p_camera =
        (map.T_map_vehicle(seen.keyframe) * camera.T_vehicle_camera).inverse() *
        map.p_map(map.landmarks[landmark]);
    if (const auto pixel = camera.camera.project(p_camera))
      data.residuals_px.push_back(static_cast<float>((*pixel - seen.pixel.cast<double>()).norm()));
    else
      ++data.behind_camera;
  }
}

// Reads the notes that the `map` verb stored about its run (apps/verbs/map_verb.cpp).
void read_run(ReportData& data) {
  const auto note = data.meta.values.find("place.summary");
  if (note == data.meta.values.end()) return;
  const auto run = nlohmann::json::parse(note->second, nullptr, false);
  if (!run.is_object()) return;
  for (const auto& stage : run.value("stages", nlohmann::json::array()))
    data.stages.push_back(
        {stage.value("name", ""), stage.value("seconds", 0.0), stage.value("peak_rss_mb", 0.0)});
  for (const auto& warning : run.value("warnings", nlohmann::json::array()))
    data.warnings.push_back(to_line(
        {Severity::kWarning, warning.value("file", ""), warning.value("line", std::int64_t{0}),
         warning.value("field", ""), warning.value("got", ""), warning.value("want", "")}));
}

std::optional<TruthComparison> compare(const Map& map,
                                       int session,
                                       const std::vector<TimedPose>& truth) {
  std::vector<std::int64_t> truth_ns;
  std::vector<std::int64_t> map_ns;
  std::vector<std::size_t> keyframes;
  for (const TimedPose& pose : truth) truth_ns.push_back(pose.t_ns);
  for (std::size_t i = 0; i < map.keyframes.size(); ++i)
    if (map.keyframes[i].session == session) {
      map_ns.push_back(map.keyframes[i].t_ns);
      keyframes.push_back(i);
    }
  std::vector<Eigen::Vector3d> reference;
  std::vector<Eigen::Vector3d> estimate;
  std::vector<std::size_t> matched;
  for (const auto& [a, b] : associate_stamps(truth_ns, map_ns, kTruthToleranceNs)) {
    reference.push_back(truth[a].T_world_vehicle.translation());
    estimate.push_back(map.T_map_vehicle(static_cast<int>(keyframes[b])).translation());
    matched.push_back(keyframes[b]);
  }
  if (reference.size() < 3) return std::nullopt;
  const bool free_scale =
      map.sessions[static_cast<std::size_t>(session)].scale_source == ScaleSource::kFree;
  TruthComparison result;
  result.session = session;
  result.error = trajectory_error(reference, estimate, free_scale);
  const Similarity& T = result.error.T_reference_estimate;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    // Converts the truth from its world to the map frame, so that one picture shows both.
    const Eigen::Vector3d in_map = T.R.transpose() * (reference[i] - T.t) / T.scale;
    result.truth.emplace_back(in_map.x(), in_map.y());
    result.error_along_m.emplace_back(map.keyframes[matched[i]].travelled_m,
                                      (T * estimate[i] - reference[i]).norm());
  }
  return result;
}

void compare_with_truth(ReportData& data) {
  for (std::size_t i = 0; i < data.map.sessions.size(); ++i) {
    const Session& session = data.map.sessions[i];
    try {
      const Drive drive = Drive::open(session_folder(data.file, session));
      if (auto comparison = compare(data.map, static_cast<int>(i), true_poses(drive)))
        data.truth.push_back(std::move(*comparison));
      else
        data.without_truth.push_back(session.name + ": the drive has no truth");
    } catch (const Error&) {
      data.without_truth.push_back(session.name + ": the drive is not at hand");
    }
  }
}

// Opens the available drives.
std::vector<std::optional<Drive>> drives_of(const ReportData& data) {
  std::vector<std::optional<Drive>> drives;
  for (const Session& session : data.map.sessions) {
    try {
      drives.emplace_back(Drive::open(session_folder(data.file, session)));
    } catch (const Error&) {
      drives.emplace_back();
    }
  }
  return drives;
}

}  // namespace

ReportData collect_report(const std::filesystem::path& map_file,
                          const std::filesystem::path& before,
                          bool look_again) {
  ReportData data;
  data.file = map_file;
  data.map = load_map(map_file);
  data.meta = load_meta(map_file);
  count_observations(data);
  read_run(data);
  compare_with_truth(data);
  const MapLayers layers(map_file);
  data.overhead = overhead_picture(layers);
  data.network = stored_network(layers);
  if (auto speeds = collect_speeds(layers))
    data.speeds = std::make_shared<const SpeedReport>(std::move(*speeds));
  const auto drives = look_again ? drives_of(data) : std::vector<std::optional<Drive>>();
  const auto images = look_again ? images_of_drives(&data.map, &drives) : KeyframeImages();
  if (auto labels = collect_labels(map_file, data.map, before, images))
    data.labels = std::make_shared<const LabelReport>(std::move(*labels));
  if (data.network)
    (void)build_road_network(driven_passes(data.map), {}, nullptr, &data.stages_of_network);
  return data;
}

}  // namespace roadbook
