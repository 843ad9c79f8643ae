#include "mapping/localisation/landmark_index.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "base/index.hpp"
#include "mapping/landmark_weights.hpp"

namespace roadbook {
namespace {

constexpr double kCell = 5.0;           // [m] of the grid of keyframes
constexpr double kFarthest = 40.0;      // [m] at which a keyframe counts as near at all
constexpr double kUnknownSigma = 0.05;  // [m] of a landmark whose covariance the map does not know

std::vector<char> chosen_sessions(const Map& map, const std::vector<std::string>& names) {
  std::vector<char> chosen(map.sessions.size(), names.empty() ? 1 : 0);
  for (const std::string& name : names) {
    const auto found = std::find_if(map.sessions.begin(), map.sessions.end(),
                                    [&](const Session& s) { return s.name == name; });
    if (found == map.sessions.end()) {
      std::string known;
      for (const Session& s : map.sessions) known += (known.empty() ? "" : ", ") + s.name;
      throw InvalidOption("--sessions", name, known);
    }
    chosen[static_cast<std::size_t>(found - map.sessions.begin())] = 1;
  }
  return chosen;
}

Eigen::Matrix3d covariance_in_map(const Map& map, const Landmark& landmark) {
  if (!is_known(landmark.covariance))
    return kUnknownSigma * kUnknownSigma * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d R = map.map_frames[at(landmark.map_frame)].T_map_frame.linear();
  return R * landmark.covariance * R.transpose();
}

}  // namespace

void NearLandmarksOptions::check() const {
  if (!(reach_m > 0.0)) throw InvalidOption("reach_m", std::to_string(reach_m), "> 0");
  if (max_landmarks < 50)
    throw InvalidOption("landmarks", std::to_string(max_landmarks), "at least 50");
}

LandmarkIndex::LandmarkIndex(const Map& map,
                             const std::vector<std::string>& sessions,
                             double least_weight)
    : map_(map),
      landmarks_(map.landmarks.size()),
      seen_from_(map.keyframes.size()),
      viewers_(map.landmarks.size()),
      keyframes_(kCell) {
  const std::vector<char> chosen = chosen_sessions(map, sessions);
  const std::vector<double> weights = landmark_weights(map);
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    landmarks_[i].p_map = map.p_map(map.landmarks[i]);
    landmarks_[i].covariance = covariance_in_map(map, map.landmarks[i]);
    landmarks_[i].weight = weights[i];
    landmarks_[i].nearest_m = std::numeric_limits<double>::max();
  }
  std::vector<std::vector<Eigen::Vector3d>> directions(landmarks_.size());
  for (const Observation& o : map.observations) {
    const Keyframe& keyframe = map.keyframes[at(o.keyframe)];
    if (!chosen[at(keyframe.session)]) continue;
    KnownLandmark& landmark = landmarks_[at(o.landmark)];
    if (landmark.weight < least_weight) continue;
    const MountedCamera& mounted = map.sessions[at(keyframe.session)].rig.cameras[at(o.camera)];
    const Eigen::Vector3d ray =
        map.T_map_vehicle(o.keyframe) * mounted.T_vehicle_camera.translation() - landmark.p_map;
    const double distance = ray.norm();
    landmark.used = true;
    landmark.nearest_m = std::min(landmark.nearest_m, distance);
    landmark.farthest_m = std::max(landmark.farthest_m, distance);
    directions[at(o.landmark)].push_back(ray / std::max(distance, 1e-9));
    seen_from_[at(o.keyframe)].push_back(o.landmark);
    viewers_[at(o.landmark)].push_back(o.keyframe);
  }
  for (auto* lists : {&seen_from_, &viewers_})
    for (std::vector<int>& list : *lists) {
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
    }
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    for (const Eigen::Vector3d& d : directions[i]) landmarks_[i].to_viewer += d;
    landmarks_[i].to_viewer.normalize();
    for (const Eigen::Vector3d& d : directions[i])
      landmarks_[i].least_cosine =
          std::min(landmarks_[i].least_cosine, d.dot(landmarks_[i].to_viewer));
  }
  for (std::size_t k = 0; k < map.keyframes.size(); ++k)
    if (chosen[at(map.keyframes[k].session)])
      keyframes_.insert(map.T_map_vehicle(static_cast<int>(k)).translation().head<2>(),
                        static_cast<int>(k));
}

const std::vector<int>& LandmarkIndex::seen_from(int keyframe) const {
  return seen_from_[at(keyframe)];
}

const std::vector<int>& LandmarkIndex::viewers(int landmark) const {
  return viewers_[at(landmark)];
}

std::vector<int> LandmarkIndex::keyframes_near(const Eigen::Vector3d& p_map,
                                               double radius_m) const {
  std::vector<int> near;
  // The grid shows one ring of cells; a wider radius walks over several of them.
  const int rings = static_cast<int>(std::ceil(std::max(0.0, radius_m - kCell) / kCell));
  for (int i = -rings; i <= rings; ++i)
    for (int j = -rings; j <= rings; ++j)
      keyframes_.visit_near(p_map.head<2>() + kCell * Eigen::Vector2d(i, j), [&](int k) {
        if ((map_.T_map_vehicle(k).translation() - p_map).norm() <= radius_m) near.push_back(k);
      });
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  return near;
}

int LandmarkIndex::nearest_keyframe(const Eigen::Vector3d& p_map) const {
  for (double radius = kCell; radius <= kFarthest; radius *= 2.0) {
    int best = -1;
    double least = radius;
    for (const int k : keyframes_near(p_map, radius)) {
      const double distance = (map_.T_map_vehicle(k).translation() - p_map).norm();
      if (distance > least || (best >= 0 && distance == least)) continue;
      least = distance;
      best = k;
    }
    if (best >= 0) return best;
  }
  return -1;
}

std::vector<int> LandmarkIndex::near(const Eigen::Isometry3d& T_map_vehicle,
                                     const NearLandmarksOptions& options) const {
  std::vector<int> all;
  for (const int k : keyframes_near(T_map_vehicle.translation(), options.reach_m))
    all.insert(all.end(), seen_from_[at(k)].begin(), seen_from_[at(k)].end());
  std::sort(all.begin(), all.end());
  struct Seen {
    double views = 0.0;  // times weight
    int landmark = 0;
  };
  std::vector<Seen> seen;
  for (std::size_t i = 0; i < all.size();) {
    std::size_t end = i;
    while (end < all.size() && all[end] == all[i]) ++end;
    const KnownLandmark& landmark = landmarks_[at(all[i])];
    const Eigen::Vector3d ray = T_map_vehicle.translation() - landmark.p_map;
    const double distance = ray.norm();
    const double angle =
        std::acos(std::clamp(landmark.least_cosine, -1.0, 1.0)) + options.angle_rad;
    // Near landmarks are seen from the camera, not from the vehicle's origin: 1.5 m is its share.
    if (distance < options.distance_factor * landmark.farthest_m + 1.5 &&
        distance + 1.5 > landmark.nearest_m / options.distance_factor &&
        (distance < 3.0 || angle > 3.14 ||
         ray.dot(landmark.to_viewer) > std::cos(angle) * distance))
      seen.push_back({static_cast<double>(end - i) * landmark.weight, all[i]});
    i = end;
  }
  if (seen.size() > options.max_landmarks) {
    std::stable_sort(seen.begin(), seen.end(),
                     [](const Seen& a, const Seen& b) { return a.views > b.views; });
    seen.resize(options.max_landmarks);
  }
  std::vector<int> landmarks;
  for (const Seen& s : seen) landmarks.push_back(s.landmark);
  std::sort(landmarks.begin(), landmarks.end());
  return landmarks;
}

}  // namespace roadbook
