#include "workflows/localisation/world_in_map.hpp"

#include <cstdint>
#include <vector>

#include "base/error.hpp"
#include "drive/true_poses.hpp"
#include "mapping/similarity.hpp"
#include "workflows/session_drives.hpp"

namespace roadbook {

std::optional<Eigen::Isometry3d> world_in_map(const std::filesystem::path& map_file,
                                              const Map& map,
                                              const Drive& drive) {
  const auto world = true_world(drive);
  if (!world) return std::nullopt;
  std::vector<Eigen::Vector3d> in_map;
  std::vector<Eigen::Vector3d> in_world;
  for (std::size_t s = 0; s < map.sessions.size(); ++s) {
    const auto folder = session_folder(map_file, map.sessions[s]);
    if (!std::filesystem::is_directory(folder)) continue;
    try {
      const Drive other = Drive::open(folder);
      if (other.digest() != map.sessions[s].drive_digest || true_world(other) != world) continue;
      std::vector<std::int64_t> truth_ns;
      std::vector<std::int64_t> map_ns;
      std::vector<std::size_t> keyframes;
      const auto truth = true_poses(other);
      for (const TimedPose& pose : truth) truth_ns.push_back(pose.t_ns);
      for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
        if (map.keyframes[k].session != static_cast<int>(s)) continue;
        map_ns.push_back(map.keyframes[k].t_ns);
        keyframes.push_back(k);
      }
      constexpr std::int64_t kToleranceNs = 5'000'000;
      for (const auto& [a, b] : associate_stamps(truth_ns, map_ns, kToleranceNs)) {
        in_world.push_back(truth[a].T_world_vehicle.translation());
        in_map.push_back(map.T_map_vehicle(static_cast<int>(keyframes[b])).translation());
      }
    } catch (const BadInput&) {  // the drive is no longer as it was: no truth from it
      continue;
    }
  }
  const Similarity fit = align(in_map, in_world, false);
  if (!fit.unique) return std::nullopt;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = fit.R;
  T.translation() = fit.t;
  return T;
}

}  // namespace roadbook
