#include "vo/track_matching.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace roadbook {
namespace {

struct Best {
  int feature = -1;
  int distance = std::numeric_limits<int>::max();
  int second = std::numeric_limits<int>::max();

  void consider(int candidate, int candidate_distance) {
    if (candidate == feature) return;
    if (candidate_distance < distance) {
      second = distance;
      distance = candidate_distance;
      feature = candidate;
    } else {
      second = std::min(second, candidate_distance);
    }
  }
  [[nodiscard]] bool good(const MatchOptions& options) const {
    return feature >= 0 && distance <= options.max_hamming &&
           (second == std::numeric_limits<int>::max() || distance <= options.max_ratio * second);
  }
};

void search(const MatchQuery& query,
            const Eigen::Vector2d& centre,
            double radius_px,
            const Features& features,
            const FeatureGrid& grid,
            Best& best) {
  grid.for_each_near(centre, radius_px, [&](int i) {
    best.consider(i, hamming(*query.descriptor, features.descriptors[static_cast<std::size_t>(i)]));
  });
}

// Pixels along the epipolar curve, from far to near, at most `step_px` apart.
std::vector<Eigen::Vector2d> epipolar_curve(const MountedCamera& mounted,
                                            const Eigen::Isometry3d& T_newcam_oldcam,
                                            const Eigen::Vector3d& bearing,
                                            double nearest_m,
                                            double step_px) {
  const Eigen::Vector3d& t = mounted.T_vehicle_camera.translation();
  const Eigen::Vector3d direction = mounted.T_vehicle_camera.linear() * bearing;
  // Below the ground nothing is seen; 1.15 and 0.05 forgive slopes and pitching.
  const double farthest_inverse =
      direction.z() < -0.02 ? std::max(0.0, -(direction.z() + 0.05)) / (1.15 * t.z()) : 0.0;
  std::vector<Eigen::Vector2d> curve;
  const double last = 1.0 / nearest_m;
  for (double inverse = farthest_inverse; inverse <= last;) {
    const Eigen::Vector3d p =
        T_newcam_oldcam.linear() * bearing + inverse * T_newcam_oldcam.translation();
    const auto pixel = mounted.camera.project(p);
    double step = 0.25;
    if (pixel && mounted.camera.contains(*pixel)) {
      if (!curve.empty() && (curve.back() - *pixel).norm() > 8.0 * step_px) break;
      curve.push_back(*pixel);
      // Pixels moved per unit of inverse depth, by a small step.
      const auto ahead = mounted.camera.project(p + 1e-3 * T_newcam_oldcam.translation());
      const double speed = ahead ? (*ahead - *pixel).norm() / 1e-3 : 0.0;
      step = std::clamp(speed > 0.0 ? step_px / speed : last, 0.005, last);
    } else if (!curve.empty()) {
      break;
    }
    inverse += step;
  }
  return curve;
}

void keep_best_per_feature(const std::vector<Best>& best,
                           std::size_t feature_count,
                           std::vector<int>& matches) {
  std::vector<int> owner(feature_count, -1);
  for (std::size_t q = 0; q < matches.size(); ++q) {
    if (matches[q] < 0) continue;
    int& current = owner[static_cast<std::size_t>(matches[q])];
    if (current >= 0 && best[static_cast<std::size_t>(current)].distance <= best[q].distance) {
      matches[q] = -1;
      continue;
    }
    if (current >= 0) matches[static_cast<std::size_t>(current)] = -1;
    current = static_cast<int>(q);
  }
}

}  // namespace

std::vector<int> match_queries(const MountedCamera& mounted,
                               const Eigen::Isometry3d& T_new_old,
                               const std::vector<MatchQuery>& queries,
                               const Features& features,
                               const FeatureGrid& grid,
                               double radius_px,
                               const MatchOptions& options) {
  const Eigen::Isometry3d T_camera_vehicle = mounted.T_vehicle_camera.inverse();
  const Eigen::Isometry3d T_newcam_oldcam = T_camera_vehicle * T_new_old * mounted.T_vehicle_camera;
  std::vector<Best> best(queries.size());
  std::vector<int> matches(queries.size(), -1);
  for (std::size_t q = 0; q < queries.size(); ++q) {
    const MatchQuery& query = queries[q];
    if (query.p_vehicle) {
      const auto pixel = mounted.camera.project(T_camera_vehicle * *query.p_vehicle);
      if (pixel) search(query, *pixel, radius_px, features, grid, best[q]);
    } else {
      for (const auto& pixel :
           epipolar_curve(mounted, T_newcam_oldcam, query.bearing, options.nearest_m, radius_px))
        search(query, pixel, radius_px, features, grid, best[q]);
    }
    if (best[q].good(options)) matches[q] = best[q].feature;
  }
  keep_best_per_feature(best, features.size(), matches);
  return matches;
}

std::vector<int> match_near(const std::vector<MatchQuery>& queries,
                            const Features& features,
                            const FeatureGrid& grid,
                            double radius_px,
                            const MatchOptions& options) {
  std::vector<Best> best(queries.size());
  std::vector<int> matches(queries.size(), -1);
  for (std::size_t q = 0; q < queries.size(); ++q) {
    search(queries[q], queries[q].pixel.cast<double>(), radius_px, features, grid, best[q]);
    if (best[q].good(options)) matches[q] = best[q].feature;
  }
  keep_best_per_feature(best, features.size(), matches);
  return matches;
}

}  // namespace roadbook
