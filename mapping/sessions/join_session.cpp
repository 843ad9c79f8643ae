#include "mapping/sessions/join_session.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/cell_grid.hpp"
#include "base/index.hpp"
#include "base/parallel.hpp"
#include "base/se3.hpp"
#include "mapping/pipeline/revisit_matching.hpp"
#include "mapping/sessions/stored_input.hpp"

namespace roadbook {
namespace {

// Appends the drive as a further session. Returns the number of tracks before it.
int append_drive(const MappingInput& drive, const PlacedSession& placed, JoinedSession& joined) {
  MappingInput& input = joined.input;
  const int session = static_cast<int>(input.half_rigs.size());
  const int first_keyframe = static_cast<int>(input.odometry.keyframes.size());
  const int first_track = static_cast<int>(input.odometry.tracks.size());
  input.half_rigs.push_back(drive.half_rigs.front());
  input.has_wheels.push_back(drive.has_wheels.front());
  joined.first_keyframe = at(first_keyframe);
  for (std::size_t k = 0; k < drive.odometry.keyframes.size(); ++k) {
    VoKeyframe keyframe = drive.odometry.keyframes[k];
    for (auto& tracks : keyframe.tracks)
      for (int& id : tracks) id += id >= 0 ? first_track : 0;
    keyframe.after_gap = keyframe.after_gap || k == 0;
    input.odometry.keyframes.push_back(std::move(keyframe));
    input.session.push_back(session);
    joined.T_map_vehicle.push_back(placed.keyframes[k].T_map_vehicle);
    joined.piece.push_back(placed.keyframes[k].piece);
  }
  for (Track track : drive.odometry.tracks) {
    for (auto& o : track.observations) o.keyframe += first_keyframe;
    input.odometry.tracks.push_back(std::move(track));
  }
  return first_track;
}

// A track goes to the landmark that most of its key points were localised with; key points without
// a track go to their own.
std::vector<TrackMatch> matches_of_localisation(const MappingInput& drive,
                                                const PlacedSession& placed,
                                                const std::vector<int>& track_of_landmark,
                                                int first_keyframe,
                                                std::vector<bool>& has_landmark) {
  std::vector<TrackMatch> same;
  std::vector<std::map<int, int>> votes(drive.odometry.tracks.size());
  const auto key_point = [&](std::size_t k, const LandmarkView& view) {
    return KeyPointId{first_keyframe + static_cast<int>(k), view.camera, view.feature};
  };
  const auto track_of = [&](std::size_t k, const LandmarkView& view) {
    return drive.odometry.keyframes[k].tracks[at(view.camera)][at(view.feature)];
  };
  for (std::size_t k = 0; k < placed.keyframes.size(); ++k)
    for (const LandmarkView& view : placed.keyframes[k].views) {
      const int track = track_of(k, view);
      if (track >= 0)
        ++votes[at(track)][view.landmark];
      else
        same.push_back({track_of_landmark[at(view.landmark)], key_point(k, view)});
    }
  std::vector<int> chosen(votes.size(), -1);
  for (std::size_t t = 0; t < votes.size(); ++t) {
    int most = 0;
    for (const auto& [landmark, count] : votes[t])
      if (count > most) {
        most = count;
        chosen[t] = landmark;
      }
  }
  has_landmark.assign(votes.size(), false);
  for (std::size_t k = 0; k < placed.keyframes.size(); ++k)
    for (const LandmarkView& view : placed.keyframes[k].views) {
      const int track = track_of(k, view);
      if (track < 0 || chosen[at(track)] != view.landmark || has_landmark[at(track)]) continue;
      has_landmark[at(track)] = true;
      same.push_back({track_of_landmark[at(view.landmark)], key_point(k, view)});
    }
  return same;
}

// For each keyframe of the session the nearest one of the map with a similar heading; -1: none.
std::vector<int> nearest_of_map(const JoinedSession& joined, const PlacePassOptions& options) {
  CellGrid<int> grid(options.radius_m);
  for (std::size_t k = 0; k < joined.first_keyframe; ++k)
    grid.insert(joined.T_map_vehicle[k].translation().head<2>(), static_cast<int>(k));
  std::vector<int> nearest;
  for (std::size_t k = joined.first_keyframe; k < joined.T_map_vehicle.size(); ++k) {
    const Eigen::Isometry3d& T_map_vehicle = joined.T_map_vehicle[k];
    int best = -1;
    double least = options.radius_m;
    grid.visit_near(T_map_vehicle.translation().head<2>(), [&](int other) {
      if (joined.piece[at(other)] != joined.piece[k]) return;
      const Eigen::Isometry3d T = joined.T_map_vehicle[at(other)].inverse() * T_map_vehicle;
      if (std::abs(heading_of(T)) > options.heading_rad || !(T.translation().norm() < least))
        return;
      least = T.translation().norm();
      best = other;
    });
    nearest.push_back(best);
  }
  return nearest;
}

// Tracks of the session without a landmark, found in the images of the map.
std::vector<TrackMatch> matches_in_map_images(const JoinedSession& joined,
                                              int first_track,
                                              const std::vector<bool>& has_landmark,
                                              const MapOptions& options) {
  std::vector<std::optional<Eigen::Vector3d>> places(joined.input.odometry.tracks.size());
  parallel_for_small(has_landmark.size(), options.num_threads, [&](std::size_t t) {
    if (has_landmark[t]) return;
    const Track& track = joined.input.odometry.tracks[at(first_track) + t];
    std::vector<KeyPointId> views;
    for (const auto& o : track.observations) views.push_back({o.keyframe, track.camera, o.feature});
    places[at(first_track) + t] =
        triangulate_key_points(joined.input, joined.T_map_vehicle, views, options.triangulation);
  });
  const auto nearest = nearest_of_map(joined, options.revisits.passes);
  std::vector<std::vector<TrackMatch>> found(nearest.size());
  parallel_for(nearest.size(), options.num_threads, [&](std::size_t i) {
    if (nearest[i] >= 0)
      found[i] = match_tracks_of(joined.input, joined.T_map_vehicle, places,
                                 joined.first_keyframe + i, at(nearest[i]), options.revisits);
  });
  std::vector<TrackMatch> same;
  for (const auto& list : found) same.insert(same.end(), list.begin(), list.end());
  return same;
}

// Tracks of the drive that show one corner. Where the map stays as it is, tracks with a landmark
// are left out: two of them may show that two landmarks are one.
std::vector<TrackMatch> matches_in_drive(const MappingInput& drive,
                                         const std::vector<TrackMatch>& matches,
                                         int first_track,
                                         int first_keyframe,
                                         const std::vector<bool>* has_landmark) {
  std::vector<TrackMatch> same;
  for (TrackMatch match : matches) {
    const KeyPointId& view = match.view;
    const int other =
        drive.odometry.keyframes[at(view.keyframe)].tracks[at(view.camera)][at(view.feature)];
    if (has_landmark != nullptr &&
        ((*has_landmark)[at(match.track)] || (other >= 0 && (*has_landmark)[at(other)])))
      continue;
    match.track += first_track;
    match.view.keyframe += first_keyframe;
    same.push_back(match);
  }
  return same;
}

std::vector<TrackMatch> matches_of_loops(const JoinedSession& joined,
                                         const std::vector<LoopClosure>& loops) {
  std::vector<TrackMatch> same;
  for (const LoopClosure& loop : loops) {
    if (!loop.edge.accepted) continue;
    const VoKeyframe& from =
        joined.input.odometry.keyframes[joined.first_keyframe + at(loop.edge.from)];
    const int to = static_cast<int>(joined.first_keyframe) + loop.edge.to;
    for (const FeatureMatch& match : loop.matches) {
      const int track = from.tracks[at(match.from_camera)][at(match.from_feature)];
      if (track >= 0) same.push_back({track, {to, match.to_camera, match.to_feature}});
    }
  }
  return same;
}

}  // namespace

bool JoinedSession::has_session(const JoinedTrack& track) const {
  return !track.views.empty() && at(track.views.back().keyframe) >= first_keyframe;
}

std::vector<int> landmarks_of_tracks(const Map& map, const std::vector<JoinedTrack>& tracks) {
  // Features of a stored keyframe begin with its observations, in their order (stored_input).
  std::vector<std::vector<std::vector<int>>> landmark(map.keyframes.size());
  for (std::size_t k = 0; k < map.keyframes.size(); ++k)
    landmark[k].resize(map.sessions[at(map.keyframes[k].session)].rig.cameras.size());
  for (const Observation& seen : map.observations)
    landmark[at(seen.keyframe)][at(seen.camera)].push_back(seen.landmark);
  std::vector<int> of_track(tracks.size(), -1);
  for (std::size_t t = 0; t < tracks.size(); ++t)
    for (const KeyPointId& view : tracks[t].views) {
      if (at(view.keyframe) >= landmark.size()) break;
      const auto& known = landmark[at(view.keyframe)][at(view.camera)];
      if (at(view.feature) >= known.size()) continue;  // a corner without a landmark
      of_track[t] = known[at(view.feature)];
      break;
    }
  return of_track;
}

JoinedSession join_session(const Map& map,
                           const MappingInput& drive,
                           const PlacedSession& placed,
                           const MapOptions& options,
                           const std::vector<TrackMatch>& same_in_drive) {
  StoredInput stored = stored_input(map);
  std::vector<int> track_of_landmark(map.landmarks.size(), -1);
  for (std::size_t t = stored.landmark_of_track.size(); t-- > 0;)
    track_of_landmark[at(stored.landmark_of_track[t])] = static_cast<int>(t);
  JoinedSession joined;
  joined.input = std::move(stored.input);
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    joined.T_map_vehicle.push_back(map.T_map_vehicle(static_cast<int>(k)));
    joined.piece.push_back(map.keyframes[k].piece);
  }
  const int first_track = append_drive(drive, placed, joined);
  std::vector<TrackMatch> same = std::move(stored.same);
  const auto add = [&](const std::vector<TrackMatch>& more) {
    same.insert(same.end(), more.begin(), more.end());
  };
  std::vector<bool> has_landmark;
  add(matches_of_localisation(drive, placed, track_of_landmark,
                              static_cast<int>(joined.first_keyframe), has_landmark));
  add(matches_in_drive(drive, same_in_drive, first_track, static_cast<int>(joined.first_keyframe),
                       options.adjust == SessionAdjust::kNone ? &has_landmark : nullptr));
  // These may show that two landmarks are one, which a map that stays as it is cannot take up.
  if (options.adjust != SessionAdjust::kNone) {
    add(matches_in_map_images(joined, first_track, has_landmark, options));
    add(matches_of_loops(joined, placed.loops));
  }
  joined.tracks = join_tracks(joined.input.odometry, same);
  const auto landmarks = landmarks_of_tracks(map, joined.tracks);
  parallel_for_small(joined.tracks.size(), options.num_threads, [&](std::size_t t) {
    JoinedTrack& track = joined.tracks[t];
    if (landmarks[t] >= 0 && !joined.has_session(track))
      track.p_map = map.p_map(map.landmarks[at(landmarks[t])]);
    else
      track.p_map = triangulate_key_points(joined.input, joined.T_map_vehicle, track.views,
                                           options.triangulation);
  });
  return joined;
}

}  // namespace roadbook
