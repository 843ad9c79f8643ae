#include "apps/evaluation/covariance/coverage.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/se3.hpp"
#include "mapping/known_covariance.hpp"
#include "mapping/similarity.hpp"

namespace roadbook {
namespace {

using Truth = std::vector<std::optional<Eigen::Isometry3d>>;

// Quantile 0.95 of chi-square.
double limit_of(int dimension) {
  switch (dimension) {
    case 1:
      return 3.841;
    case 2:
      return 5.991;
    case 3:
      return 7.815;
    default:
      ROADBOOK_ASSERT(dimension == 6);
      return 12.592;
  }
}

Truth truth_of_keyframes(const Map& map, const Drive& drive) {
  constexpr std::int64_t kToleranceNs = 5'000'000;
  const auto poses = drive.truth();
  std::vector<std::int64_t> truth_ns;
  std::vector<std::int64_t> map_ns;
  for (const auto& pose : poses) truth_ns.push_back(pose.t_ns);
  for (const Keyframe& keyframe : map.keyframes) map_ns.push_back(keyframe.t_ns);
  Truth truth(map.keyframes.size());
  for (const auto& [a, b] : associate_stamps(truth_ns, map_ns, kToleranceNs))
    truth[b] = poses[a].T_world_vehicle;
  return truth;
}

void judge_poses(const Map& map, const Truth& truth, Coverage& coverage) {
  std::map<int, std::size_t> gauge;  // of each piece: its first keyframe
  for (std::size_t k = 0; k < truth.size(); ++k) {
    if (!truth[k]) continue;
    const auto [first, is_first] = gauge.try_emplace(map.keyframes[k].piece, k);
    if (is_first) continue;
    const Matrix6d& C = map.keyframes[k].covariance;
    if (!is_known(C)) {
      ++coverage.unknown;
      continue;
    }
    const std::size_t g = first->second;
    const Eigen::Isometry3d estimated =
        map.T_map_vehicle(static_cast<int>(g)).inverse() * map.T_map_vehicle(static_cast<int>(k));
    const Vector6d e = se3_log(estimated.inverse() * (truth[g]->inverse() * *truth[k]));
    const auto squared = [&](Eigen::Index n) {
      return e.head(n).dot(C.topLeftCorner(n, n).ldlt().solve(e.head(n)));
    };
    coverage.position.add(squared(2), 2);
    coverage.position_3d.add(squared(3), 3);
    coverage.heading.add(e(5) * e(5) / C(5, 5), 1);
    coverage.six.add(squared(6), 6);
  }
}

// Range of a pixel [m]; empty on an outline, where the range around the pixel changes.
std::optional<double> range_at(const cv::Mat& ranges, const Eigen::Vector2d& pixel) {
  constexpr int kAround = 2;
  constexpr double kSameShare = 0.04;
  const int u = static_cast<int>(std::lround(pixel.x()));
  const int v = static_cast<int>(std::lround(pixel.y()));
  if (u < kAround || v < kAround || u + kAround >= ranges.cols || v + kAround >= ranges.rows)
    return std::nullopt;
  const double middle = 1e-3 * ranges.at<std::uint16_t>(v, u);
  for (int dv = -kAround; dv <= kAround; ++dv)
    for (int du = -kAround; du <= kAround; ++du) {
      const double other = 1e-3 * ranges.at<std::uint16_t>(v + dv, u + du);
      if (!(other > 0.0) || std::abs(other - middle) > kSameShare * middle) return std::nullopt;
    }
  return middle;
}

// The nearest view of each landmark, by image (keyframe, camera).
using ImageViews = std::map<std::pair<int, int>, std::vector<const Observation*>>;

ImageViews nearest_views(const Map& map) {
  std::vector<const Observation*> nearest(map.landmarks.size(), nullptr);
  std::vector<double> least(map.landmarks.size(), std::numeric_limits<double>::max());
  for (const Observation& seen : map.observations) {
    const auto id = static_cast<std::size_t>(seen.landmark);
    const double range_m =
        (map.T_map_vehicle(seen.keyframe).translation() - map.p_map(map.landmarks[id])).norm();
    if (range_m >= least[id]) continue;
    least[id] = range_m;
    nearest[id] = &seen;
  }
  ImageViews views;
  for (const Observation* seen : nearest)
    if (seen) views[{seen->keyframe, seen->camera}].push_back(seen);
  return views;
}

void judge_landmarks(const Map& map, const Drive& drive, Coverage& coverage) {
  for (const auto& [image, views] : nearest_views(map)) {
    const auto& mounted = drive.rig().cameras[static_cast<std::size_t>(image.second)];
    const Keyframe& keyframe = map.keyframes[static_cast<std::size_t>(image.first)];
    const auto file = drive.folder() / "truth" / "range" / mounted.name /
                      (std::to_string(keyframe.t_ns) + ".png");
    const cv::Mat ranges = cv::imread(file.string(), cv::IMREAD_UNCHANGED);
    if (ranges.empty()) continue;
    const Eigen::Isometry3d T_map_camera =
        map.T_map_vehicle(image.first) * mounted.T_vehicle_camera;
    for (const Observation* seen : views) {
      const Landmark& landmark = map.landmarks[static_cast<std::size_t>(seen->landmark)];
      const Eigen::Vector2d pixel = seen->pixel.cast<double>();
      const auto bearing = mounted.camera.bearing(pixel);
      const auto range_m = range_at(ranges, pixel);
      if (!bearing || !range_m || !is_known(landmark.covariance)) continue;
      const Eigen::Vector3d ray = T_map_camera.linear() * *bearing;
      const double error_m = ray.dot(map.p_map(landmark) - T_map_camera.translation()) - *range_m;
      coverage.landmarks.add(error_m * error_m / ray.dot(landmark.covariance * ray), 1);
    }
  }
}

}  // namespace

double RegionShare::share() const {
  return count > 0 ? static_cast<double>(inside) / static_cast<double>(count) : std::nan("");
}

double RegionShare::mean_square() const {
  return count > 0 ? squares / static_cast<double>(count) : std::nan("");
}

void RegionShare::add(double squared_distance, int dimension) {
  ++count;
  // A covariance that is not positive definite holds nothing.
  if (squared_distance >= 0.0 && squared_distance <= limit_of(dimension)) ++inside;
  squares += squared_distance / dimension;
}

void RegionShare::add(const RegionShare& other) {
  count += other.count;
  inside += other.inside;
  squares += other.squares;
}

void Coverage::add(const Coverage& other) {
  position.add(other.position);
  position_3d.add(other.position_3d);
  heading.add(other.heading);
  six.add(other.six);
  landmarks.add(other.landmarks);
  unknown += other.unknown;
}

Coverage coverage_of(const Map& map, const Drive& drive) {
  Coverage coverage;
  judge_poses(map, truth_of_keyframes(map, drive), coverage);
  judge_landmarks(map, drive, coverage);
  return coverage;
}

}  // namespace roadbook
