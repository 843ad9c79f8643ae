#include "mapping/joined_tracks.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <tuple>

#include "base/index.hpp"
#include "base/parallel.hpp"
#include "mapping/union_find.hpp"
#include "vo/triangulation.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kMaxRays = 16;

}  // namespace

std::vector<JoinedTrack> join_tracks(const VoResult& odometry,
                                     const std::vector<TrackMatch>& same) {
  UnionFind sets(odometry.tracks.size());
  // Key points without a track go to the first track that they match.
  std::map<std::tuple<int, int, int>, int> lone;  // keyframe, camera, feature -> track
  for (const auto& [track, view] : same) {
    const int other =
        odometry.keyframes[at(view.keyframe)].tracks[at(view.camera)][at(view.feature)];
    if (other >= 0) {
      sets.join(track, other);
      continue;
    }
    const auto [place, is_new] =
        lone.try_emplace({view.keyframe, view.camera, view.feature}, track);
    if (!is_new) sets.join(place->second, track);
  }
  std::vector<int> place(odometry.tracks.size(), -1);
  std::vector<JoinedTrack> joined;
  for (std::size_t t = 0; t < odometry.tracks.size(); ++t) {
    const Track& track = odometry.tracks[t];
    int& index = place[at(sets.find(static_cast<int>(t)))];
    if (index < 0) {
      index = static_cast<int>(joined.size());
      joined.emplace_back();
    }
    JoinedTrack& corner = joined[at(index)];
    corner.revisited |= !corner.views.empty();
    for (const auto& o : track.observations)
      corner.views.push_back({o.keyframe, track.camera, o.feature});
  }
  for (const auto& [view, track] : lone) {
    JoinedTrack& corner = joined[at(place[at(sets.find(track))])];
    corner.revisited = true;
    corner.views.push_back({std::get<0>(view), std::get<1>(view), std::get<2>(view)});
  }
  for (auto& corner : joined) {
    const auto image = [](const KeyPointId& v) { return std::tuple(v.keyframe, v.camera); };
    std::stable_sort(corner.views.begin(), corner.views.end(),
                     [&](const KeyPointId& a, const KeyPointId& b) { return image(a) < image(b); });
    const auto last =
        std::unique(corner.views.begin(), corner.views.end(),
                    [&](const KeyPointId& a, const KeyPointId& b) { return image(a) == image(b); });
    corner.views.erase(last, corner.views.end());
    corner.views.shrink_to_fit();
  }
  std::erase_if(joined, [](const JoinedTrack& c) { return c.views.size() < 2; });
  return joined;
}

std::optional<Eigen::Vector3d> triangulate_key_points(
    const MappingInput& input,
    const std::vector<Eigen::Isometry3d>& T_map_vehicle,
    std::span<const KeyPointId> views,
    const TriangulationOptions& options) {
  if (views.size() < 2) return std::nullopt;
  std::vector<Ray> rays;
  double focal = 1.0;
  const std::size_t used = std::min(views.size(), kMaxRays);
  for (std::size_t r = 0; r < used; ++r) {
    const KeyPointId& view = views[r * (views.size() - 1) / (used - 1)];
    const auto& mounted = input.rig_of(view.keyframe).cameras[at(view.camera)];
    const auto bearing = mounted.camera.bearing(input.pixel(view));
    if (!bearing) continue;
    focal = mounted.camera.focal_px();
    const Eigen::Isometry3d T = T_map_vehicle[at(view.keyframe)] * mounted.T_vehicle_camera;
    rays.push_back({T.translation(), T.linear() * *bearing});
  }
  const auto point = triangulate(rays, options.min_parallax_rad);
  if (!point || !(point->max_error_rad * focal <= options.max_error_px)) return std::nullopt;
  if (!((point->p_world - rays.front().origin).norm() <= options.max_range_m)) return std::nullopt;
  return point->p_world;
}

std::vector<std::optional<Eigen::Vector3d>> triangulate_odometry_tracks(
    const MappingInput& input,
    const std::vector<Eigen::Isometry3d>& T_map_vehicle,
    const TriangulationOptions& options) {
  const auto& tracks = input.odometry.tracks;
  std::vector<std::optional<Eigen::Vector3d>> places(tracks.size());
  parallel_for_small(tracks.size(), options.num_threads, [&](std::size_t i) {
    std::vector<KeyPointId> views;
    views.reserve(tracks[i].observations.size());
    for (const auto& o : tracks[i].observations)
      views.push_back({o.keyframe, tracks[i].camera, o.feature});
    places[i] = triangulate_key_points(input, T_map_vehicle, views, options);
  });
  return places;
}

void triangulate_tracks(const MappingInput& input,
                        const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                        const TriangulationOptions& options,
                        std::vector<JoinedTrack>& tracks) {
  parallel_for_small(tracks.size(), options.num_threads, [&](std::size_t i) {
    tracks[i].p_map = triangulate_key_points(input, T_map_vehicle, tracks[i].views, options);
  });
}

}  // namespace roadbook
