#include "mapping/pipeline/truth_error.hpp"

#include "drive/true_poses.hpp"
#include "mapping/similarity.hpp"

namespace roadbook {
namespace {

constexpr std::int64_t kTruthToleranceNs = 5'000'000;

}  // namespace

std::optional<TruthError> truth_error(const std::vector<Drive>& drives,
                                      const Map& map,
                                      bool free_scale) {
  if (drives.size() != 1) return std::nullopt;
  std::vector<Eigen::Vector3d> reference;
  std::vector<Eigen::Vector3d> estimate;
  const auto truth = true_poses(drives.front());
  std::vector<std::int64_t> truth_t;
  std::vector<std::int64_t> map_t;
  for (const auto& pose : truth) truth_t.push_back(pose.t_ns);
  for (const auto& keyframe : map.keyframes) map_t.push_back(keyframe.t_ns);
  for (const auto& [a, b] : associate_stamps(truth_t, map_t, kTruthToleranceNs)) {
    reference.push_back(truth[a].T_world_vehicle.translation());
    estimate.push_back(map.T_map_vehicle(static_cast<int>(b)).translation());
  }
  if (reference.size() < 3) return std::nullopt;
  const auto error = trajectory_error(reference, estimate, free_scale);
  return TruthError{error.median_m, error.p95_m};
}

}  // namespace roadbook
