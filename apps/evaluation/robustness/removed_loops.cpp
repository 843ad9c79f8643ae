#include "apps/evaluation/robustness/removed_loops.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/random.hpp"

namespace roadbook {

LoopedMap map_with_loops(MappingInput input, const MapOptions& options, const Progress& progress) {
  LoopedMap map;
  map.input = std::move(input);
  LoopOptions loop_options = options.loops;
  loop_options.num_threads = options.num_threads;
  map.loops = find_loops(map.input, loop_options, progress);
  map.relaxed = relax_poses(map.input, map.loops, options, progress);
  map.adjusted = adjust(map.input, map.loops, map.relaxed, options, progress);
  add_covariances(map.input, map.relaxed, {}, options, map.adjusted);
  if (options.covariances && !map.adjusted.covariance.usable)
    throw Refused("error: covariances: got " + map.adjusted.covariance.message +
                  ", want those of all keyframes");
  return map;
}

std::vector<std::size_t> drawn_loops(const LoopedMap& map, std::size_t count, std::uint64_t seed) {
  std::vector<std::size_t> accepted;
  for (std::size_t i = 0; i < map.loops.size(); ++i)
    if (map.loops[i].edge.accepted) accepted.push_back(i);
  Random random(seed, "removed loops");
  while (accepted.size() > count)
    accepted.erase(accepted.begin() + static_cast<std::ptrdiff_t>(random.below(accepted.size())));
  return accepted;
}

RemovedLoop remove_loop(const LoopedMap& map,
                        std::size_t loop,
                        bool adjusts,
                        const MapOptions& options,
                        const Progress& progress) {
  std::vector<LoopClosure> loops = map.loops;
  loops[loop].edge.accepted = false;
  const Relaxed relaxed = relax_poses(map.input, loops, options, progress);
  MapOptions plain = options;
  plain.covariances = false;
  const std::vector<Eigen::Isometry3d> moved =
      adjusts ? adjust(map.input, loops, relaxed, plain, progress).T_map_vehicle
              : relaxed.T_map_vehicle;
  const std::vector<Eigen::Isometry3d>& stayed =
      adjusts ? map.adjusted.T_map_vehicle : map.relaxed.T_map_vehicle;
  RemovedLoop removed{loop};
  for (std::size_t k = 1; k < moved.size(); ++k) {
    const Matrix6d& covariance = map.adjusted.covariance.poses[k];
    const Eigen::Isometry3d by = stayed[k].inverse() * moved[k];
    const Eigen::Vector3d d = by.translation();
    const Eigen::Matrix3d place = covariance.topLeftCorner<3, 3>();
    const double position = std::sqrt(d.dot(place.ldlt().solve(d)));
    const double heading = std::abs(so3_log(by.linear()).z()) / std::sqrt(covariance(5, 5));
    if (!std::isfinite(position) || !std::isfinite(heading))  // a maximum would skip NaN
      throw Refused("error: keyframe " + std::to_string(k) +
                    ": covariance: got none, or one that is not positive, want a known one");
    removed.position = std::max(removed.position, position);
    removed.heading = std::max(removed.heading, heading);
  }
  return removed;
}

}  // namespace roadbook
