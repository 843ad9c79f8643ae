#include "mapping/sessions/extended_map.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "base/cell_grid.hpp"
#include "base/index.hpp"
#include "mapping/lone_corners.hpp"
#include "mapping/pipeline/ground.hpp"
#include "mapping/travelled.hpp"
#include "vo/track_options.hpp"

namespace roadbook {
namespace {

// Map frames by place; each belongs to the piece of a keyframe in it.
class FrameFinder {
 public:
  static constexpr double kReachM = 2.0;

  explicit FrameFinder(const Map& map) : grid_(kReachM) {
    std::vector<bool> known(map.map_frames.size(), false);
    for (const Keyframe& keyframe : map.keyframes) {
      if (known[at(keyframe.map_frame)]) continue;
      known[at(keyframe.map_frame)] = true;
      add(map, keyframe.map_frame, keyframe.piece);
    }
  }
  void add(const Map& map, int frame, int piece) {
    const Eigen::Vector3d p = map.map_frames[at(frame)].T_map_frame.translation();
    grid_.insert(p.head<2>(), {frame, piece, p});
  }
  [[nodiscard]] int nearest(const Eigen::Vector3d& p_map, int piece) const {
    int best = -1;
    double least = kReachM;
    grid_.visit_near(p_map.head<2>(), [&](const Frame& frame) {
      const double distance = (frame.p_map - p_map).norm();
      if (frame.piece != piece || !(distance < least)) return;
      least = distance;
      best = frame.frame;
    });
    return best;
  }

 private:
  struct Frame {
    int frame;
    int piece;
    Eigen::Vector3d p_map;
  };
  CellGrid<Frame> grid_;
};

bool is_same_pose(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return a.matrix() == b.matrix();
}

// Poses of the map that moved, and the keyframes of the session.
void place_keyframes(const Map& map,
                     const JoinedSession& joined,
                     const PlacedSession& placed,
                     const Adjusted& adjusted,
                     Map& extended) {
  const auto travelled_m = travelled_distances(joined.input, adjusted.T_map_vehicle);
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    Keyframe& keyframe = extended.keyframes[k];
    if (adjusted.covariance.usable) keyframe.covariance = adjusted.covariance.poses[k];
    if (is_same_pose(adjusted.T_map_vehicle[k], joined.T_map_vehicle[k])) continue;
    keyframe.T_frame_vehicle =
        map.map_frames[at(keyframe.map_frame)].T_map_frame.inverse() * adjusted.T_map_vehicle[k];
    keyframe.travelled_m = travelled_m[k];
  }
  FrameFinder frames(map);
  const int session = static_cast<int>(map.sessions.size());
  for (std::size_t i = 0; i < placed.keyframes.size(); ++i) {
    const std::size_t k = joined.first_keyframe + i;
    const VoKeyframe& tracked = joined.input.odometry.keyframes[k];
    const Eigen::Isometry3d& T_map_vehicle = adjusted.T_map_vehicle[k];
    Keyframe keyframe;
    keyframe.session = session;
    keyframe.t_ns = tracked.t_ns;
    keyframe.drive_frame = static_cast<int>(tracked.frame);
    keyframe.piece = placed.keyframes[i].piece;
    keyframe.map_frame = frames.nearest(T_map_vehicle.translation(), keyframe.piece);
    if (keyframe.map_frame < 0) {
      keyframe.map_frame = static_cast<int>(extended.map_frames.size());
      extended.map_frames.push_back({T_map_vehicle});
      frames.add(extended, keyframe.map_frame, keyframe.piece);
    }
    keyframe.T_frame_vehicle =
        extended.map_frames[at(keyframe.map_frame)].T_map_frame.inverse() * T_map_vehicle;
    keyframe.covariance =
        adjusted.covariance.usable ? adjusted.covariance.poses[k] : placed.keyframes[i].covariance;
    keyframe.travelled_m = travelled_m[k];
    keyframe.reversing = tracked.reversing;
    keyframe.after_gap = tracked.after_gap && i > 0;
    keyframe.wheels = tracked.wheels;
    extended.keyframes.push_back(keyframe);
  }
}

// Observations and lone corners of the map, by keyframe and camera: features of a stored keyframe
// are the observations, then the corners (stored_input).
template <typename Stored>
class ByImage {
 public:
  ByImage(const Map& map, const std::vector<Stored>& all) : images_(map.keyframes.size()) {
    for (std::size_t k = 0; k < images_.size(); ++k)
      images_[k].resize(map.sessions[at(map.keyframes[k].session)].rig.cameras.size());
    for (const Stored& one : all) images_[at(one.keyframe)][at(one.camera)].push_back(&one);
  }
  [[nodiscard]] const std::vector<const Stored*>& at_image(int keyframe, int camera) const {
    return images_[at(keyframe)][at(camera)];
  }

 private:
  std::vector<std::vector<std::vector<const Stored*>>> images_;
};

struct ExtendedTracks {
  std::vector<int> of_landmark;  // of each landmark of the map: its new index; -1: it is lost
  std::vector<std::vector<std::vector<bool>>> used_corners;  // keyframe, camera, corner
};

ExtendedTracks place_landmarks(const Map& map,
                               const JoinedSession& joined,
                               const Adjusted& adjusted,
                               const MapOptions& options,
                               Map& extended) {
  const auto& tracks = adjusted.tracks;
  const ByImage<Observation> stored(map, map.observations);
  const ByImage<LoneCorner> corners(map, map.corners);
  const std::vector<int> landmarks = landmarks_of_tracks(map, tracks);
  ExtendedTracks result;
  result.of_landmark.assign(map.landmarks.size(), -1);
  result.used_corners.resize(map.keyframes.size());
  for (std::size_t k = 0; k < map.keyframes.size(); ++k)
    for (std::size_t c = 0; c < map.sessions[at(map.keyframes[k].session)].rig.cameras.size(); ++c)
      result.used_corners[k].emplace_back(
          corners.at_image(static_cast<int>(k), static_cast<int>(c)).size(), false);

  // Whether a landmark lies on the ground is judged where the session sees it.
  std::vector<std::size_t> seen;
  std::vector<JoinedTrack> seen_tracks;
  for (std::size_t t = 0; t < tracks.size(); ++t)
    if (joined.has_session(tracks[t]) && tracks[t].p_map) {
      seen.push_back(t);
      seen_tracks.push_back(tracks[t]);
    }
  const auto views =
      view_from_above(joined.input, adjusted.T_map_vehicle, seen_tracks, options.bundle.ground);
  const double level = ground_level(views, options.bundle.ground);
  std::vector<int> ground(tracks.size(), -1);
  std::vector<const Eigen::Matrix3d*> covariance(tracks.size(), nullptr);
  for (std::size_t i = 0; i < seen.size(); ++i)
    ground[seen[i]] = on_ground(views[i], level, options.bundle.ground) ? 1 : 0;
  if (adjusted.landmark_covariance.of_track.size() == tracks.size())
    for (std::size_t t = 0; t < tracks.size(); ++t)
      covariance[t] = &adjusted.landmark_covariance.of_track[t];

  std::vector<std::size_t> views_before(map.landmarks.size(), 0);
  for (const Observation& o : map.observations) ++views_before[at(o.landmark)];
  extended.landmarks.clear();
  extended.observations.clear();
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    const JoinedTrack& track = tracks[t];
    if (!track.p_map || static_cast<int>(track.views.size()) < options.min_views) continue;
    const int id = static_cast<int>(extended.landmarks.size());
    const bool is_known = landmarks[t] >= 0 && result.of_landmark[at(landmarks[t])] < 0;
    Landmark landmark;
    if (is_known) {
      landmark = map.landmarks[at(landmarks[t])];
      result.of_landmark[at(landmarks[t])] = id;
    } else {
      landmark.map_frame = extended.keyframes[at(track.views.front().keyframe)].map_frame;
    }
    const bool has_moved = !is_known || *track.p_map != map.p_map(landmark);
    if (has_moved)
      landmark.p_frame =
          extended.map_frames[at(landmark.map_frame)].T_map_frame.inverse() * *track.p_map;
    if (!is_known || joined.has_session(track))
      landmark.descriptor = descriptor_of(joined.input, track);
    if (ground[t] >= 0 && !is_known) landmark.ground = ground[t] == 1;
    if (covariance[t] != nullptr && roadbook::is_known(*covariance[t]))
      landmark.covariance = *covariance[t];
    else if (is_known && track.views.size() < views_before[at(landmarks[t])])
      landmark.covariance = unknown_covariance<Eigen::Matrix3d>();  // it had that of more views
    extended.landmarks.push_back(landmark);
    for (const KeyPointId& view : track.views) {
      if (at(view.keyframe) < joined.first_keyframe) {
        const auto& known = stored.at_image(view.keyframe, view.camera);
        if (at(view.feature) < known.size()) {
          Observation kept = *known[at(view.feature)];
          kept.landmark = id;
          extended.observations.push_back(kept);
          continue;
        }
        const std::size_t corner = at(view.feature) - known.size();
        result.used_corners[at(view.keyframe)][at(view.camera)][corner] = true;
      }
      const Eigen::Vector2d pixel = full_size_pixel(joined.input.pixel(view));
      extended.observations.push_back(
          {id, view.keyframe, view.camera, pixel.cast<float>(),
           static_cast<float>(kFullPerHalfPixel * options.bundle.feature_sigma_px)});
    }
  }
  std::stable_sort(extended.observations.begin(), extended.observations.end(),
                   [](const Observation& a, const Observation& b) {
                     return std::pair(a.keyframe, a.camera) < std::pair(b.keyframe, b.camera);
                   });
  return result;
}

void place_corners(const Map& map,
                   const JoinedSession& joined,
                   const Adjusted& adjusted,
                   const ExtendedTracks& tracks,
                   const MapOptions& options,
                   Map& extended) {
  extended.corners.clear();
  std::size_t in_image = 0;
  for (std::size_t i = 0; i < map.corners.size(); ++i) {
    const LoneCorner& corner = map.corners[i];
    const bool is_next = i > 0 && map.corners[i - 1].keyframe == corner.keyframe &&
                         map.corners[i - 1].camera == corner.camera;
    in_image = is_next ? in_image + 1 : 0;
    if (!tracks.used_corners[at(corner.keyframe)][at(corner.camera)][in_image])
      extended.corners.push_back(corner);
  }
  const auto more =
      lone_corners(joined.input, adjusted.tracks, options.min_views, joined.first_keyframe);
  extended.corners.insert(extended.corners.end(), more.begin(), more.end());
}

void place_evidence(const Map& map,
                    const PlacedSession& placed,
                    const JoinedSession& joined,
                    const std::vector<int>& of_landmark,
                    Map& extended) {
  extended.landmark_sessions.clear();
  for (LandmarkSession row : map.landmark_sessions) {
    row.landmark = of_landmark[at(row.landmark)];
    if (row.landmark >= 0) extended.landmark_sessions.push_back(row);
  }
  const int session = static_cast<int>(map.sessions.size());
  std::map<int, LandmarkSession> rows;  // by landmark of the extended map
  for (std::size_t i = 0; i < placed.keyframes.size(); ++i) {
    const PlacedKeyframe& keyframe = placed.keyframes[i];
    if (!keyframe.is_localised) continue;
    std::vector<int> seen;
    for (const LandmarkView& view : keyframe.views) seen.push_back(view.landmark);
    std::sort(seen.begin(), seen.end());
    for (const int landmark : keyframe.in_view) {
      const int id = of_landmark[at(landmark)];
      if (id < 0) continue;
      LandmarkSession& row =
          rows.try_emplace(id, LandmarkSession{id, session, 0, 0, {}}).first->second;
      ++row.expected;
      if (!std::binary_search(seen.begin(), seen.end(), landmark)) continue;
      ++row.seen;
      row.last_ns = joined.input.odometry.keyframes[joined.first_keyframe + i].t_ns;
    }
  }
  for (const auto& [landmark, row] : rows) extended.landmark_sessions.push_back(row);
  std::stable_sort(extended.landmark_sessions.begin(), extended.landmark_sessions.end(),
                   [](const LandmarkSession& a, const LandmarkSession& b) {
                     return std::pair(a.landmark, a.session) < std::pair(b.landmark, b.session);
                   });
}

void place_loops(const PlacedSession& placed,
                 const JoinedSession& joined,
                 const Adjusted& adjusted,
                 Map& extended) {
  const int first = static_cast<int>(joined.first_keyframe);
  for (std::size_t i = 0; i < placed.keyframes.size(); ++i) {
    const PlacedKeyframe& keyframe = placed.keyframes[i];
    if (!keyframe.is_localised || keyframe.near < 0) continue;
    LoopEdge edge;
    edge.from = keyframe.near;
    edge.to = first + static_cast<int>(i);
    edge.T_from_to =
        adjusted.T_map_vehicle[at(edge.from)].inverse() * adjusted.T_map_vehicle[at(edge.to)];
    if (is_known(keyframe.covariance)) {
      const Eigen::LLT<Matrix6d> llt(keyframe.covariance);
      if (llt.info() == Eigen::Success) edge.information = llt.solve(Matrix6d::Identity());
    }
    edge.inliers = static_cast<int>(keyframe.views.size());
    edge.accepted = true;
    edge.weight = 1.0;
    edge.reason = "localised in the map";
    extended.loops.push_back(std::move(edge));
  }
  for (const LoopClosure& loop : placed.loops) {
    LoopEdge edge = loop.edge;
    edge.from += first;
    edge.to += first;
    extended.loops.push_back(std::move(edge));
  }
}

void set_scales(const Map& map,
                const PlacedSession& placed,
                const Adjusted& adjusted,
                const MapOptions& options,
                const std::optional<double>& ground_sigma,
                Map& extended) {
  Session& session = extended.sessions.back();
  session.scale_source = map.sessions.front().scale_source;
  session.scale_sigma = map.sessions.front().scale_sigma;
  set_scale(adjusted, map.sessions.size(), ground_sigma, session);
  session.localised_share = placed.localised_share();
  for (std::size_t s = 0; s < map.sessions.size(); ++s)
    if (options.adjust == SessionAdjust::kAll && adjusted.stage.scale_of_session[s] >= 0)
      set_scale(adjusted, s, std::nullopt, extended.sessions[s]);
}

}  // namespace

Map extended_map(const Map& map,
                 const Session& session,
                 const JoinedSession& joined,
                 const PlacedSession& placed,
                 const Adjusted& adjusted,
                 const MapOptions& options,
                 const std::optional<double>& ground_sigma) {
  Map extended = map;
  extended.sessions.push_back(session);
  set_scales(map, placed, adjusted, options, ground_sigma, extended);
  place_keyframes(map, joined, placed, adjusted, extended);
  const ExtendedTracks tracks = place_landmarks(map, joined, adjusted, options, extended);
  place_corners(map, joined, adjusted, tracks, options, extended);
  place_evidence(map, placed, joined, tracks.of_landmark, extended);
  place_loops(placed, joined, adjusted, extended);
  return extended;
}

Map adjusted_map(const Map& map,
                 const JoinedSession& joined,
                 const Adjusted& adjusted,
                 const MapOptions& options) {
  Map moved = map;
  place_keyframes(map, joined, {}, adjusted, moved);
  const ExtendedTracks tracks = place_landmarks(map, joined, adjusted, options, moved);
  place_corners(map, joined, adjusted, tracks, options, moved);
  place_evidence(map, {}, joined, tracks.of_landmark, moved);
  return moved;
}

}  // namespace roadbook
