#include "mapping/pipeline/revisit_matching.hpp"

#include <algorithm>

#include "base/parallel.hpp"
#include "vo/feature_grid.hpp"
#include "vo/triangulation.hpp"

namespace roadbook {
namespace {

// For each keyframe the nearest earlier keyframe of another pass with a similar heading; -1: none.
std::vector<int> nearest_earlier(const MappingInput& input,
                                 const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                                 const std::vector<int>& component,
                                 const PlacePassOptions& options) {
  std::vector<int> nearest(component.size(), -1);
  std::vector<double> least(component.size(), options.radius_m);
  visit_earlier_passes(input, T_map_vehicle, options, [&](const EarlierPass& pair) {
    const std::size_t k = pair.keyframe;
    const double distance = pair.way_m.norm();
    if (component[pair.earlier] != component[k] || !(distance < least[k])) return;
    least[k] = distance;
    nearest[k] = static_cast<int>(pair.earlier);
  });
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
  const auto nearest = nearest_earlier(input, T_map_vehicle, component, options.passes);
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
