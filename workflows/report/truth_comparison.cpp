#include "workflows/report/truth_comparison.hpp"

#include <optional>

#include "base/error.hpp"
#include "drive/drive.hpp"
#include "drive/true_poses.hpp"
#include "workflows/session_drives.hpp"

namespace roadbook {
namespace {

constexpr std::int64_t kTruthToleranceNs = 5'000'000;

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

}  // namespace

TruthComparisons compare_with_truth(const std::filesystem::path& map_file, const Map& map) {
  TruthComparisons result;
  for (std::size_t i = 0; i < map.sessions.size(); ++i) {
    const Session& session = map.sessions[i];
    try {
      const Drive drive = Drive::open(session_folder(map_file, session));
      if (auto comparison = compare(map, static_cast<int>(i), true_poses(drive)))
        result.sessions.push_back(std::move(*comparison));
      else
        result.without_truth.push_back(session.name + ": the drive has no truth");
    } catch (const Error&) {
      result.without_truth.push_back(session.name + ": the drive is not at hand");
    }
  }
  return result;
}

}  // namespace roadbook
