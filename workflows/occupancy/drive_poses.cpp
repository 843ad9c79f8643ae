#include "workflows/occupancy/drive_poses.hpp"

#include <algorithm>
#include <map>
#include <memory>

#include "mapping/session_track.hpp"
#include "workflows/localisation/localisation_figures.hpp"
#include "workflows/localisation/localise_in_map.hpp"

namespace roadbook {
namespace {

std::size_t nearest_in_time(const std::vector<std::pair<std::int64_t, std::size_t>>& stamps,
                            std::int64_t t_ns) {
  const auto after =
      std::lower_bound(stamps.begin(), stamps.end(), std::pair{t_ns, std::size_t{0}});
  if (after == stamps.end()) return stamps.back().second;
  if (after == stamps.begin()) return after->second;
  const auto before = after - 1;
  return after->first - t_ns < t_ns - before->first ? after->second : before->second;
}

std::size_t nearest_in_place(const std::vector<Eigen::Vector2d>& places, const Eigen::Vector2d& p) {
  std::size_t best = 0;
  for (std::size_t k = 1; k < places.size(); ++k)
    if ((places[k] - p).squaredNorm() < (places[best] - p).squaredNorm()) best = k;
  return best;
}

PoseAt localised_poses(const Drive& drive,
                       const std::filesystem::path& map_file,
                       int num_threads,
                       Messages& messages) {
  LocaliseRequest request;
  request.drive = drive.folder();
  request.map = map_file;
  request.options.tracking.num_threads = num_threads;
  const LocaliseResult found = localise_in_map(request, messages);
  if (found.refusal) throw *found.refusal;
  messages.warn(found.warnings);
  auto poses = std::make_shared<std::vector<TimedPose>>();
  for (const TimedFrame& frame : found.frames)
    if (frame.pose.status == LocalisationStatus::kLocalised ||
        frame.pose.status == LocalisationStatus::kRelocalised)
      poses->push_back({frame.pose.t_ns, frame.pose.T_map_vehicle});
  return [poses](std::int64_t t_ns) { return true_pose_at(*poses, t_ns); };
}

}  // namespace

std::vector<std::size_t> DrivePoses::anchors_of(const std::vector<RangeScan>& scans,
                                                const Map& map) const {
  std::vector<std::size_t> anchors;
  std::vector<std::pair<std::int64_t, std::size_t>> stamps;
  std::vector<Eigen::Vector2d> places;
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    if (map.keyframes[k].session == session) stamps.emplace_back(map.keyframes[k].t_ns, k);
    places.emplace_back(map.T_map_vehicle(static_cast<int>(k)).translation().head<2>());
  }
  for (const RangeScan& scan : scans)
    anchors.push_back(stamps.empty() ? nearest_in_place(places, scan.origin)
                                     : nearest_in_time(stamps, scan.t_ns));
  return anchors;
}

DrivePoses drive_poses(const Drive& drive,
                       const Map& map,
                       const std::filesystem::path& map_file,
                       int num_threads,
                       Messages& messages) {
  DrivePoses poses;
  const std::string digest = drive.digest();
  for (std::size_t s = 0; s < map.sessions.size(); ++s)
    if (map.sessions[s].drive_digest == digest) poses.session = static_cast<int>(s);
  if (poses.session >= 0) {
    const auto track = std::make_shared<SessionTrack>(map, poses.session);
    poses.at = [track](std::int64_t t_ns) { return track->at(t_ns); };
    return poses;
  }
  poses.localised = true;
  poses.at = localised_poses(drive, map_file, num_threads, messages);
  return poses;
}

std::vector<PatchAnchor> patch_anchors(const Map& map) {
  std::vector<PatchAnchor> anchors;
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    const Keyframe& keyframe = map.keyframes[k];
    anchors.push_back({map.sessions[static_cast<std::size_t>(keyframe.session)].name, keyframe.t_ns,
                       plane_pose(map.T_map_vehicle(static_cast<int>(k)))});
  }
  return anchors;
}

PoseOfKeyframe keyframe_poses(const Map& map) {
  std::map<std::pair<std::string, std::int64_t>, PlanePose> poses;
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    const Keyframe& keyframe = map.keyframes[k];
    const auto& name = map.sessions[static_cast<std::size_t>(keyframe.session)].name;
    poses[{name, keyframe.t_ns}] = plane_pose(map.T_map_vehicle(static_cast<int>(k)));
  }
  return [poses = std::move(poses)](const std::string& session,
                                    std::int64_t t_ns) -> std::optional<PlanePose> {
    const auto found = poses.find({session, t_ns});
    if (found == poses.end()) return std::nullopt;
    return found->second;
  };
}

}  // namespace roadbook
