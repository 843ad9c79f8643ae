#pragma once

#include <cmath>
#include <filesystem>
#include <optional>
#include <vector>

#include "base/se3.hpp"
#include "drive/drive.hpp"
#include "mapping/build_map.hpp"
#include "mapping/map_file.hpp"
#include "mapping/similarity.hpp"

namespace roadbook::test {

/// An empty folder of its own for a test.
inline std::filesystem::path fresh_folder(const std::string& name) {
  const auto folder = std::filesystem::path(::testing::TempDir()) / ("roadbook_" + name);
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

/// Truth of each keyframe of a map built from one drive.
inline std::vector<std::optional<Eigen::Isometry3d>> truth_of(const Map& map, const Drive& drive) {
  const auto truth = drive.truth();
  std::vector<std::int64_t> truth_t;
  std::vector<std::int64_t> map_t;
  for (const auto& pose : truth) truth_t.push_back(pose.t_ns);
  for (const auto& keyframe : map.keyframes) map_t.push_back(keyframe.t_ns);
  std::vector<std::optional<Eigen::Isometry3d>> poses(map.keyframes.size());
  for (const auto& [a, b] : associate_stamps(truth_t, map_t, 5'000'000))
    poses[b] = truth[a].T_world_vehicle;
  return poses;
}

inline TrajectoryError error_of(const Map& map, const Drive& drive, bool with_scale) {
  const auto truth = truth_of(map, drive);
  std::vector<Eigen::Vector3d> reference;
  std::vector<Eigen::Vector3d> estimate;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    if (!truth[k]) continue;
    reference.push_back(truth[k]->translation());
    estimate.push_back(map.T_map_vehicle(static_cast<int>(k)).translation());
  }
  return trajectory_error(reference, estimate, with_scale);
}

/// Loop edges against truth. A revisit: an earlier keyframe at least 10 m of travel before, within
/// 1 m and 0.35 rad.
struct LoopVerdict {
  int right = 0;
  int wrong = 0;     ///< off by more than 0.3 m or 0.05 rad
  int revisits = 0;  ///< keyframes that are one
  int recalled = 0;  ///< of them, those that an accepted edge leads to
  [[nodiscard]] double recall() const { return static_cast<double>(recalled) / revisits; }
};

inline LoopVerdict judge_loops(const Map& map, const Drive& drive) {
  const auto truth = truth_of(map, drive);
  LoopVerdict verdict;
  std::vector<bool> reached(map.keyframes.size(), false);
  for (const auto& loop : map.loops) {
    if (!loop.accepted) continue;
    const auto& a = truth[static_cast<std::size_t>(loop.from)];
    const auto& b = truth[static_cast<std::size_t>(loop.to)];
    if (!a || !b) continue;
    const Eigen::Isometry3d off = (a->inverse() * *b).inverse() * loop.T_from_to;
    const bool good = off.translation().norm() < 0.3 && so3_log(off.linear()).norm() < 0.05;
    ++(good ? verdict.right : verdict.wrong);
    if (good) reached[static_cast<std::size_t>(loop.to)] = true;
  }
  for (std::size_t k = 0; k < truth.size(); ++k) {
    bool revisit = false;
    for (std::size_t e = 0; e < k && !revisit && truth[k]; ++e) {
      if (!truth[e] || map.keyframes[k].travelled_m - map.keyframes[e].travelled_m < 10.0) continue;
      const Eigen::Isometry3d T = truth[e]->inverse() * *truth[k];
      revisit = T.translation().norm() < 1.0 && std::abs(heading_of(T)) < 0.35;
    }
    verdict.revisits += revisit ? 1 : 0;
    verdict.recalled += revisit && reached[k] ? 1 : 0;
  }
  return verdict;
}

}  // namespace roadbook::test
