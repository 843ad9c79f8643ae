#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "base/se3.hpp"
#include "drive/drive.hpp"
#include "mapping/pipeline/build_map.hpp"
#include "mapping/similarity.hpp"
#include "mapping/store/map_file.hpp"

namespace roadbook::test {

/// Creates an empty folder for one test.
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

/// True length of the driven path from the first keyframe to the last, along the keyframes.
inline double driven_truth_m(const Map& map, const Drive& drive) {
  const auto truth = truth_of(map, drive);
  double sum_m = 0.0;
  for (std::size_t k = 1; k < truth.size(); ++k)
    if (truth[k] && truth[k - 1] && !map.keyframes[k].after_gap)
      sum_m += (truth[k]->translation() - truth[k - 1]->translation()).norm();
  return sum_m;
}

/// Compares loop edges with truth. A keyframe is a revisit if an earlier keyframe lies within 1 m
/// and 0.35 rad, at least 10 m of travel before.
struct LoopVerdict {
  int right = 0;
  int wrong = 0;     ///< off by more than 0.3 m or 0.05 rad
  int revisits = 0;  ///< keyframes that are a revisit
  int recalled = 0;  ///< revisits that an accepted edge leads to
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

/// Distances of landmarks from the surface that their nearest view shows, for views within
/// `reach_m`, by the simulation's range images (`truth/range`).
inline std::vector<double> landmark_errors(const Map& map, const Drive& drive, double reach_m) {
  const auto truth = truth_of(map, drive);
  const Similarity T_world_map = error_of(map, drive, false).T_reference_estimate;
  struct Nearest {
    const Observation* view = nullptr;
    double range_m = std::numeric_limits<double>::max();
  };
  std::vector<Nearest> nearest(map.landmarks.size());
  for (const auto& seen : map.observations) {
    const auto id = static_cast<std::size_t>(seen.landmark);
    const double range =
        (map.T_map_vehicle(seen.keyframe).translation() - map.p_map(map.landmarks[id])).norm();
    if (range < nearest[id].range_m) nearest[id] = {&seen, range};
  }
  std::map<std::pair<int, int>, std::vector<std::size_t>> by_image;
  for (std::size_t id = 0; id < nearest.size(); ++id)
    if (nearest[id].view)
      by_image[{nearest[id].view->keyframe, nearest[id].view->camera}].push_back(id);
  std::vector<double> errors;
  for (const auto& [image, ids] : by_image) {
    const auto k = static_cast<std::size_t>(image.first);
    const auto& mounted = drive.rig().cameras[static_cast<std::size_t>(image.second)];
    if (!truth[k]) continue;
    const cv::Mat ranges = cv::imread((drive.folder() / "truth" / "range" / mounted.name /
                                       (std::to_string(map.keyframes[k].t_ns) + ".png"))
                                          .string(),
                                      cv::IMREAD_UNCHANGED);
    if (ranges.empty()) continue;
    for (const std::size_t id : ids) {
      const Eigen::Vector2d pixel = nearest[id].view->pixel.cast<double>();
      const auto bearing = mounted.camera.bearing(pixel);
      const double range_m =
          1e-3 * ranges.at<std::uint16_t>(static_cast<int>(std::lround(pixel.y())),
                                          static_cast<int>(std::lround(pixel.x())));
      if (!bearing || !(range_m > 0.0) || range_m > reach_m) continue;
      const Eigen::Vector3d p = *truth[k] * mounted.T_vehicle_camera * (range_m * *bearing);
      errors.push_back((T_world_map * map.p_map(map.landmarks[id]) - p).norm());
    }
  }
  return errors;
}

/// Shares of keyframes whose true error lies in the 95 % region that the map states, relative to
/// the first keyframe of a map in one piece.
struct Coverage {
  double position = 0.0;  ///< x and y
  double heading = 0.0;
  double six = 0.0;
  int unknown = 0;  ///< keyframes without a covariance
};

inline Coverage coverage_of(const Map& map, const Drive& drive) {
  const auto truth = truth_of(map, drive);
  Coverage coverage;
  double count = 0.0;
  for (std::size_t k = 1; k < truth.size(); ++k) {
    if (!truth[k] || !truth[0]) continue;
    const Matrix6d& C = map.keyframes[k].covariance;
    if (!C.allFinite()) {
      ++coverage.unknown;
      continue;
    }
    const Eigen::Isometry3d moved =
        map.T_map_vehicle(0).inverse() * map.T_map_vehicle(static_cast<int>(k));
    const Vector6d e = se3_log(moved.inverse() * (truth[0]->inverse() * *truth[k]));
    const Eigen::Matrix2d flat = C.topLeftCorner<2, 2>();
    count += 1.0;
    coverage.position += e.head<2>().dot(flat.ldlt().solve(e.head<2>())) < 5.991 ? 1.0 : 0.0;
    coverage.heading += e(5) * e(5) < 3.841 * C(5, 5) ? 1.0 : 0.0;
    coverage.six += e.dot(C.ldlt().solve(e)) < 12.592 ? 1.0 : 0.0;
  }
  for (double* share : {&coverage.position, &coverage.heading, &coverage.six})
    *share /= std::max(1.0, count);
  return coverage;
}

inline double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace roadbook::test
