#include "mapping/pipeline/revisit_matching.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/cell_grid.hpp"
#include "base/parallel.hpp"
#include "base/se3.hpp"
#include "mapping/loops/loop_closure.hpp"
#include "mapping/travelled.hpp"
#include "vo/feature_grid.hpp"
#include "vo/triangulation.hpp"

namespace roadbook {
namespace {

// For each keyframe the nearest earlier keyframe of another pass with a similar heading; -1: none.
std::vector<int> nearest_earlier(const MappingInput& input,
                                 const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                                 const std::vector<int>& component,
                                 const RevisitOptions& options) {
  const auto& keyframes = input.odometry.keyframes;
  const auto segments = segments_of(keyframes);
  const auto travelled_m = travelled_distances(input, T_map_vehicle);
  CellGrid<int> earlier(options.radius_m);
  std::vector<int> nearest(keyframes.size(), -1);
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    const Eigen::Vector3d p = T_map_vehicle[k].translation();
    double best = options.radius_m;
    earlier.visit_near(p.head<2>(), [&](int other) {
      const auto o = static_cast<std::size_t>(other);
      if (component[o] != component[k]) return;
      if (segments[o] == segments[k] && travelled_m[k] - travelled_m[o] < options.min_travel_m)
        return;
      const Eigen::Isometry3d T = T_map_vehicle[o].inverse() * T_map_vehicle[k];
      if (std::abs(heading_of(T)) > options.heading_rad || !(T.translation().norm() < best)) return;
      best = T.translation().norm();
      nearest[k] = other;
    });
    earlier.insert(p.head<2>(), static_cast<int>(k));
  }
  return nearest;
}

}  // namespace

std::vector<TrackMatch> match_tracks_of(const MappingInput& input,
                                        const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                                        const std::vector<std::optional<Eigen::Vector3d>>& places,
                                        std::size_t from_keyframe,
                                        std::size_t to_keyframe,
                                        const RevisitOptions& options) {
  std::vector<TrackMatch> same;
  const VoKeyframe& from = input.odometry.keyframes[from_keyframe];
  const VoKeyframe& to = input.odometry.keyframes[to_keyframe];
  const Rig& rig = input.rig_of(static_cast<int>(to_keyframe));
  const std::size_t cameras = std::min(from.features.size(), to.features.size());
  for (std::size_t c = 0; c < cameras; ++c) {
    const auto& mounted = rig.cameras[c];
    const FeatureGrid grid(to.features[c].pixels, mounted.camera.width, mounted.camera.height);
    const Eigen::Isometry3d T_camera_map =
        (T_map_vehicle[to_keyframe] * mounted.T_vehicle_camera).inverse();
    std::vector<int> owner(to.features[c].size(), -1);
    std::vector<int> owner_distance(to.features[c].size(), options.max_hamming + 1);
    for (std::size_t f = 0; f < from.features[c].size(); ++f) {
      const int id = from.tracks[c][f];
      if (id < 0 || !places[static_cast<std::size_t>(id)]) continue;
      const auto pixel =
          mounted.camera.project(T_camera_map * *places[static_cast<std::size_t>(id)]);
      if (!pixel || !mounted.camera.contains(*pixel)) continue;
      int best = -1;
      int distance = 1000;
      int second = 1000;
      grid.for_each_near(*pixel, options.search_px, [&](int g) {
        const int d = hamming(from.features[c].descriptors[f],
                              to.features[c].descriptors[static_cast<std::size_t>(g)]);
        if (d < distance) {
          second = distance;
          distance = d;
          best = g;
        } else {
          second = std::min(second, d);
        }
      });
      if (best < 0 || distance > options.max_hamming || distance > options.max_ratio * second)
        continue;
      const auto g = static_cast<std::size_t>(best);
      if (distance >= owner_distance[g]) continue;
      owner_distance[g] = distance;
      owner[g] = id;
    }
    for (std::size_t g = 0; g < owner.size(); ++g)
      if (owner[g] >= 0)
        same.push_back(
            {owner[g], {static_cast<int>(to_keyframe), static_cast<int>(c), static_cast<int>(g)}});
  }
  return same;
}

std::vector<TrackMatch> match_revisits(const MappingInput& input,
                                       const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                                       const std::vector<int>& component,
                                       const RevisitOptions& options) {
  const auto nearest = nearest_earlier(input, T_map_vehicle, component, options);
  TriangulationOptions triangulation;
  triangulation.num_threads = options.num_threads;
  const auto places = triangulate_odometry_tracks(input, T_map_vehicle, triangulation);
  std::vector<std::vector<TrackMatch>> found(nearest.size());
  parallel_for(nearest.size(), options.num_threads, [&](std::size_t k) {
    if (nearest[k] >= 0)
      found[k] = match_tracks_of(input, T_map_vehicle, places, static_cast<std::size_t>(nearest[k]),
                                 k, options);
  });
  std::vector<TrackMatch> same;
  for (const auto& list : found) same.insert(same.end(), list.begin(), list.end());
  return same;
}

}  // namespace roadbook
