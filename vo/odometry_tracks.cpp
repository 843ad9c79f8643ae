#include <algorithm>
#include <cmath>

#include "vo/odometry_state.hpp"
#include "vo/triangulation.hpp"

namespace roadbook {
namespace {
constexpr std::size_t kMaxRays = 10;  // of a track, for triangulation
// Change of a corner's distance over a track without wheels. FAST finds another point of the object
// when its image grows: along a street, long tracks bias the distances.
constexpr double kMostRangeRatio = 1.6;
}  // namespace

bool VisualOdometry::State::consistent(int track_id,
                                       int camera,
                                       const Eigen::Vector2f& pixel,
                                       const Eigen::Isometry3d& T_odom_new) const {
  const Track& track = result.tracks[static_cast<std::size_t>(track_id)];
  const auto& mounted = rig.cameras[static_cast<std::size_t>(camera)];
  const Eigen::Isometry3d T_odom_camera = T_odom_new * mounted.T_vehicle_camera;
  if (track.p_odom) {
    const auto predicted = mounted.camera.project(T_odom_camera.inverse() * *track.p_odom);
    return predicted && (*predicted - pixel.cast<double>()).norm() <= options.inlier_px;
  }
  const auto bearing = mounted.camera.bearing(pixel.cast<double>());
  if (!bearing) return false;
  const TrackObservation& o = track.observations.back();
  const Eigen::Isometry3d T_new_old =
      T_odom_camera.inverse() *
      result.keyframes[static_cast<std::size_t>(o.keyframe)].T_odom_vehicle *
      mounted.T_vehicle_camera;
  const Eigen::Vector3d old_in_new = T_new_old.linear() * bearing_of(camera, o);
  const Eigen::Vector3d normal = T_new_old.translation().cross(old_in_new);
  if (normal.norm() < 1e-3)
    return std::acos(std::min(1.0, old_in_new.dot(*bearing))) < 2.0 * tolerance_rad;
  return std::abs(std::asin(std::clamp(normal.normalized().dot(*bearing), -1.0, 1.0))) <=
         tolerance_rad;
}

bool VisualOdometry::State::has_new_size(int track_id, const Eigen::Isometry3d& T_odom_new) const {
  const Track& track = result.tracks[static_cast<std::size_t>(track_id)];
  if (!track.p_odom) return false;
  const Eigen::Vector3d mount =
      rig.cameras[static_cast<std::size_t>(track.camera)].T_vehicle_camera.translation();
  const auto& first = keyframe_at(track.observations.front().keyframe);
  const double before = (first.T_odom_vehicle * mount - *track.p_odom).norm();
  const double now = (T_odom_new * mount - *track.p_odom).norm();
  return now > kMostRangeRatio * before || before > kMostRangeRatio * now;
}

void VisualOdometry::State::triangulate_tracks(const VoKeyframe& keyframe) {
  std::vector<Ray> rays;
  const int oldest = static_cast<int>(result.keyframes.size()) - kWindowPoses;
  for (std::size_t c = 0; c < keyframe.tracks.size(); ++c)
    for (const int id : keyframe.tracks[c]) {
      if (id < 0) continue;
      Track& track = result.tracks[static_cast<std::size_t>(id)];
      // Without wheels, lengths of the window follow the ground, and poses before it stay.
      std::size_t begin = 0;
      while (!keyframe.wheels && begin < track.observations.size() &&
             track.observations[begin].keyframe < oldest)
        ++begin;
      const std::size_t count = track.observations.size() - begin;
      if (count < 2) continue;
      rays.clear();
      const std::size_t used = std::min(count, kMaxRays);  // first and last among them
      for (std::size_t r = 0; r < used; ++r) {
        const std::size_t i = begin + r * (count - 1) / (used - 1);
        const TrackObservation& o = track.observations[i];
        const Eigen::Isometry3d T_odom_camera =
            result.keyframes[static_cast<std::size_t>(o.keyframe)].T_odom_vehicle *
            rig.cameras[c].T_vehicle_camera;
        rays.push_back(
            {T_odom_camera.translation(), T_odom_camera.linear() * bearing_of(track.camera, o)});
      }
      const auto point = triangulate(rays, options.min_parallax_rad);
      if (point && point->max_error_rad <= 1.5 * tolerance_rad)
        track.p_odom = point->p_world;
      else if (point)
        track.p_odom.reset();
    }
}

// Most corners are never found again: the tracks begun in the keyframe before the last that stayed
// alone are dropped, and those behind them move up.
void VisualOdometry::State::forget_lone_tracks() {
  const std::size_t first = newest_tracks;
  std::vector<int> moved(result.tracks.size() - first, -1);
  std::size_t next = first;
  for (std::size_t t = first; t < result.tracks.size(); ++t) {
    if (result.tracks[t].observations.size() < 2) continue;
    moved[t - first] = static_cast<int>(next);
    if (next != t) result.tracks[next] = std::move(result.tracks[t]);
    ++next;
  }
  result.tracks.erase(result.tracks.begin() + static_cast<std::ptrdiff_t>(next),
                      result.tracks.end());
  const auto renumber = [&](int& id) {
    if (id >= static_cast<int>(first)) id = moved[static_cast<std::size_t>(id) - first];
  };
  const std::size_t keyframes = result.keyframes.size();
  for (std::size_t k = keyframes - std::min<std::size_t>(2, keyframes); k < keyframes; ++k)
    for (auto& tracks : result.keyframes[k].tracks)
      for (int& id : tracks) renumber(id);
  for (auto& tracks : active)
    for (int& id : tracks) renumber(id);
}

void VisualOdometry::State::start_tracks(VoKeyframe& keyframe,
                                         std::size_t index,
                                         const KnownPlaces& places) {
  newest_tracks = result.tracks.size();
  for (std::size_t c = 0; c < keyframe.features.size(); ++c) {
    keyframe.tracks[c].resize(keyframe.features[c].size(), -1);
    for (std::size_t f = 0; f < keyframe.features[c].size(); ++f) {
      if (keyframe.tracks[c][f] >= 0) continue;
      const int id = static_cast<int>(result.tracks.size());
      result.tracks.push_back(
          {static_cast<int>(c), {{static_cast<int>(index), static_cast<int>(f)}}, std::nullopt});
      if (const auto place = places.find({c, f}); place != places.end())
        result.tracks.back().p_odom = place->second;
      keyframe.tracks[c][f] = id;
      active[c].push_back(id);
    }
  }
}

void VisualOdometry::State::accept(VoFrame&& frame, const Matches& matches, VoKeyframe&& keyframe) {
  const std::size_t index = result.keyframes.size();
  std::map<std::pair<std::size_t, std::size_t>, int> resized;
  keyframe.tracks.resize(frame.features.size());
  for (std::size_t c = 0; c < frame.features.size(); ++c) {
    keyframe.tracks[c].assign(frame.features[c].size(), -1);
    for (std::size_t i = 0; i < matches.tracks[c].size(); ++i) {
      const int feature = matches.features[c][i];
      const int id = matches.tracks[c][i];
      if (feature < 0) continue;
      const auto f = static_cast<std::size_t>(feature);
      if (!consistent(id, static_cast<int>(c), frame.features[c].pixels[f],
                      keyframe.T_odom_vehicle))
        continue;
      if (!keyframe.wheels && has_new_size(id, keyframe.T_odom_vehicle)) {
        resized[{c, f}] = id;
        continue;
      }
      keyframe.tracks[c][f] = id;
      result.tracks[static_cast<std::size_t>(id)].observations.push_back(
          {static_cast<int>(index), feature});
    }
  }
  keyframe.frame = frame.frame;
  keyframe.t_ns = frame.t_ns;
  keyframe.features = std::move(frame.features);
  result.keyframes.push_back(std::move(keyframe));
  VoKeyframe& added = result.keyframes.back();
  triangulate_tracks(added);
  adjust_newest();
  // Corners whose images have another size begin anew, where the window has put them.
  KnownPlaces places;
  for (const auto& [feature, id] : resized) {
    places[feature] = *result.tracks[static_cast<std::size_t>(id)].p_odom;
    std::erase(active[feature.first], id);
  }
  for (auto& tracks : active)
    std::erase_if(tracks, [&](int id) {
      const auto& seen = result.tracks[static_cast<std::size_t>(id)].observations;
      // A corner that was not found again at once was hardly one; looking on for it costs the most.
      const int allowed = seen.size() == 1 ? 0 : options.max_skipped;
      return seen.back().keyframe < static_cast<int>(index) - allowed;
    });
  forget_lone_tracks();
  start_tracks(added, index, places);
}

}  // namespace roadbook
