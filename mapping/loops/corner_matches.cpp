#include "mapping/loops/corner_matches.hpp"

#include <algorithm>
#include <limits>

#include "vo/feature_grid.hpp"

namespace roadbook {

std::vector<KnownCorner> known_corners(const VoResult& odometry, int keyframe) {
  std::vector<KnownCorner> corners;
  const VoKeyframe& k = odometry.keyframes[static_cast<std::size_t>(keyframe)];
  const Eigen::Isometry3d T_vehicle_odom = k.T_odom_vehicle.inverse();
  for (std::size_t c = 0; c < k.features.size(); ++c)
    for (std::size_t f = 0; f < k.features[c].size(); ++f) {
      const int id = k.tracks[c][f];
      if (id < 0) continue;
      const auto& p = odometry.tracks[static_cast<std::size_t>(id)].p_odom;
      if (!p) continue;
      const Eigen::Vector3d p_vehicle = T_vehicle_odom * *p;
      if (p_vehicle.norm() > 60.0) continue;  // says nothing about the position
      corners.push_back(
          {static_cast<int>(c), static_cast<int>(f), p_vehicle, &k.features[c].descriptors[f]});
    }
  return corners;
}

std::vector<CornerMatch> match_by_descriptor(const std::vector<KnownCorner>& corners,
                                             const VoKeyframe& later,
                                             bool any_camera,
                                             const CornerMatchOptions& options) {
  struct Owner {
    int corner = -1;
    int distance = std::numeric_limits<int>::max();
  };
  std::vector<std::vector<Owner>> owners(later.features.size());
  for (std::size_t c = 0; c < later.features.size(); ++c)
    owners[c].resize(later.features[c].size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    NearestDescriptor best;
    std::size_t best_camera = 0;
    for (std::size_t c = 0; c < later.features.size(); ++c) {
      if (!any_camera && static_cast<int>(c) != corners[i].camera) continue;
      const auto near = nearest_descriptor(*corners[i].descriptor, later.features[c].descriptors);
      const int second =
          std::min({near.second, std::max(near.distance, best.distance), best.second});
      if (near.distance < best.distance) {
        best = near;
        best_camera = c;
      }
      best.second = second;
    }
    if (best.index < 0 || best.distance > options.max_hamming ||
        best.distance > options.max_ratio * best.second)
      continue;
    Owner& owner = owners[best_camera][static_cast<std::size_t>(best.index)];
    if (best.distance < owner.distance) owner = {static_cast<int>(i), best.distance};
  }
  std::vector<CornerMatch> matches;
  for (std::size_t c = 0; c < owners.size(); ++c)
    for (std::size_t f = 0; f < owners[c].size(); ++f)
      if (owners[c][f].corner >= 0)
        matches.push_back({owners[c][f].corner, static_cast<int>(c), static_cast<int>(f)});
  return matches;
}

std::vector<CornerMatch> match_by_pose(const Rig& rig,
                                       const std::vector<KnownCorner>& corners,
                                       const VoKeyframe& later,
                                       const Eigen::Isometry3d& T_later_earlier,
                                       double radius_px) {
  std::vector<CornerMatch> matches;
  for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
    const auto& mounted = rig.cameras[c];
    const FeatureGrid grid(later.features[c].pixels, mounted.camera.width, mounted.camera.height);
    const Eigen::Isometry3d T_camera_earlier = mounted.T_vehicle_camera.inverse() * T_later_earlier;
    std::vector<int> taken(later.features[c].size(), -1);
    std::vector<int> distance_of(later.features[c].size(), 140);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const auto pixel = mounted.camera.project(T_camera_earlier * corners[i].p_vehicle);
      if (!pixel || !mounted.camera.contains(*pixel)) continue;
      grid.for_each_near(*pixel, radius_px, [&](int f) {
        const auto feature = static_cast<std::size_t>(f);
        const int distance =
            hamming(*corners[i].descriptor, later.features[c].descriptors[feature]);
        if (distance < distance_of[feature]) {
          distance_of[feature] = distance;
          taken[feature] = static_cast<int>(i);
        }
      });
    }
    for (std::size_t f = 0; f < taken.size(); ++f)
      if (taken[f] >= 0) matches.push_back({taken[f], static_cast<int>(c), static_cast<int>(f)});
  }
  return matches;
}

}  // namespace roadbook
