#include "mapping/sessions/adjust_session.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "base/error.hpp"
#include "base/index.hpp"
#include "mapping/cameras/common_camera_errors.hpp"
#include "mapping/pipeline/landmark_covariance.hpp"
#include "mapping/pipeline/track_agreement.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kSessionPosesPerFree = 2;  // of poses of the map
constexpr int kFixedViews = 6;                   // of a point, by poses that do not move
constexpr double kGaugeM = 0.3;                  // standard deviations of the first session's poses
constexpr double kGaugeRad = 0.1;

// The poses that may move: those of the session and half as many of the map, which see most of the
// session's landmarks.
std::vector<bool> free_poses(const JoinedSession& joined,
                             const std::vector<JoinedTrack>& tracks,
                             SessionAdjust adjust) {
  const std::size_t count = joined.T_map_vehicle.size();
  std::vector<bool> free(count, adjust == SessionAdjust::kAll);
  for (std::size_t k = joined.first_keyframe; k < count; ++k) free[k] = true;
  if (adjust != SessionAdjust::kNear) return free;
  constexpr int kLeastShared = 10;
  std::vector<int> shared(joined.first_keyframe, 0);
  for (const JoinedTrack& track : tracks) {
    if (!track.p_map || !joined.has_session(track)) continue;
    for (const KeyPointId& view : track.views)
      if (at(view.keyframe) < joined.first_keyframe) ++shared[at(view.keyframe)];
  }
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < shared.size(); ++k)
    if (shared[k] >= kLeastShared) order.push_back(k);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return shared[a] > shared[b]; });
  const std::size_t most = (count - joined.first_keyframe) / kSessionPosesPerFree;
  if (order.size() > most) order.resize(most);
  for (const std::size_t k : order) free[k] = true;
  return free;
}

// Splits the tracks of the session whose views contradict each other. What is split off goes to the
// end.
void split_tracks_of_session(const JoinedSession& joined,
                             const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                             double reprojection_median_px,
                             const MapOptions& options,
                             std::vector<JoinedTrack>& tracks) {
  std::vector<std::size_t> places;
  std::vector<JoinedTrack> judged;
  for (std::size_t t = 0; t < tracks.size(); ++t)
    if (tracks[t].revisited && joined.has_session(tracks[t])) {
      places.push_back(t);
      judged.push_back(std::move(tracks[t]));
    }
  split_wrong_joins(joined.input, T_map_vehicle, reprojection_median_px, options, judged);
  for (std::size_t i = 0; i < judged.size(); ++i) {
    if (i < places.size())
      tracks[places[i]] = std::move(judged[i]);
    else
      tracks.push_back(std::move(judged[i]));
  }
}

// The session's views of landmarks that do not move: those that do not fit are dropped.
void drop_views_off_landmarks(const JoinedSession& joined,
                              const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                              const Map& map,
                              double gate_px,
                              std::vector<JoinedTrack>& tracks) {
  const std::vector<int> landmarks = landmarks_of_tracks(map, tracks);
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    if (landmarks[t] < 0 || !joined.has_session(tracks[t])) continue;
    tracks[t].p_map = map.p_map(map.landmarks[at(landmarks[t])]);
    std::erase_if(tracks[t].views, [&](const KeyPointId& view) {
      if (at(view.keyframe) < joined.first_keyframe) return false;
      const MountedCamera& mounted = joined.input.rig_of(view.keyframe).cameras[at(view.camera)];
      const auto pixel = mounted.camera.project(
          (T_map_vehicle[at(view.keyframe)] * mounted.T_vehicle_camera).inverse() *
          *tracks[t].p_map);
      return !pixel || !((*pixel - joined.input.pixel(view)).norm() <= gate_px);
    });
  }
}

// Indices of the tracks that a free pose sees.
std::vector<std::size_t> tracks_of(const std::vector<JoinedTrack>& tracks,
                                   const std::vector<bool>& free) {
  std::vector<std::size_t> chosen;
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    const auto& views = tracks[t].views;
    if (tracks[t].p_map && std::any_of(views.begin(), views.end(),
                                       [&](const auto& view) { return free[at(view.keyframe)]; }))
      chosen.push_back(t);
  }
  return chosen;
}

// Keeps all observations of free poses, and of each point a few of fixed ones, spread evenly.
void thin_fixed_views(BundleProblem& problem) {
  std::vector<BundleObservation> kept;
  kept.reserve(problem.observations.size());
  for (std::size_t begin = 0, end = 0; begin < problem.observations.size(); begin = end) {
    std::vector<std::size_t> fixed;
    for (end = begin; end < problem.observations.size() &&
                      problem.observations[end].point == problem.observations[begin].point;
         ++end)
      if (problem.poses[at(problem.observations[end].pose)].fixed) fixed.push_back(end);
    std::set<std::size_t> dropped(fixed.begin(), fixed.end());
    const std::size_t count = std::min<std::size_t>(fixed.size(), kFixedViews);
    for (std::size_t i = 0; i < count; ++i)
      dropped.erase(fixed[i * (fixed.size() - 1) / std::max<std::size_t>(1, count - 1)]);
    for (std::size_t i = begin; i < end; ++i)
      if (!dropped.contains(i)) kept.push_back(problem.observations[i]);
  }
  problem.observations = std::move(kept);
}

// A piece of the session that nothing joins to the map keeps its first pose.
void fix_lone_pieces(const JoinedSession& joined, BundleProblem& problem) {
  std::set<int> held(joined.piece.begin(),
                     joined.piece.begin() + static_cast<std::ptrdiff_t>(joined.first_keyframe));
  for (std::size_t k = joined.first_keyframe; k < joined.piece.size(); ++k)
    if (held.insert(joined.piece[k]).second) problem.poses[k].fixed = true;
}

void add_gauge(const JoinedSession& joined, BundleProblem& problem) {
  Matrix6d information = Matrix6d::Zero();
  information.diagonal() << Eigen::Vector3d::Constant(1.0 / (kGaugeM * kGaugeM)),
      Eigen::Vector3d::Constant(1.0 / (kGaugeRad * kGaugeRad));
  std::set<int> first_session;  // of each piece of the map
  std::vector<int> session_of_piece;
  for (std::size_t k = 0; k < joined.first_keyframe; ++k) {
    const auto piece = at(joined.piece[k]);
    if (session_of_piece.size() <= piece) session_of_piece.resize(piece + 1, -1);
    if (session_of_piece[piece] < 0) session_of_piece[piece] = joined.input.session[k];
    if (session_of_piece[piece] == joined.input.session[k])
      problem.priors.push_back({static_cast<int>(k), joined.T_map_vehicle[k], information});
  }
}

void fix_landmarks(const Map& map, const std::vector<int>& landmarks, BundleStage& stage) {
  for (std::size_t p = 0; p < stage.problem.points.size(); ++p) {
    const int landmark = landmarks[at(stage.track_of_point[p])];
    if (landmark < 0) continue;
    stage.problem.points[p].p_map = map.p_map(map.landmarks[at(landmark)]);
    stage.problem.points[p].fixed = true;
  }
}

void add_landmark_covariances(const JoinedSession& joined,
                              const MapOptions& options,
                              Adjusted& adjusted) {
  std::vector<std::size_t> places;
  std::vector<JoinedTrack> tracks;
  // Those that the session sees, and those that it moved.
  const auto has_moved = [&](std::size_t t) {
    return t >= joined.tracks.size() || adjusted.tracks[t].p_map != joined.tracks[t].p_map;
  };
  for (std::size_t t = 0; t < adjusted.tracks.size(); ++t)
    if (adjusted.tracks[t].p_map && (joined.has_session(adjusted.tracks[t]) || has_moved(t))) {
      places.push_back(t);
      tracks.push_back(adjusted.tracks[t]);
    }
  const auto found = landmark_covariances(joined.input, adjusted.T_map_vehicle, tracks,
                                          options.bundle.feature_sigma_px, options.triangulation);
  adjusted.landmark_covariance.factor = found.factor;
  adjusted.landmark_covariance.compared = found.compared;
  adjusted.landmark_covariance.of_track.assign(adjusted.tracks.size(),
                                               unknown_covariance<Eigen::Matrix3d>());
  for (std::size_t i = 0; i < places.size(); ++i)
    adjusted.landmark_covariance.of_track[places[i]] = found.of_track[i];
}

}  // namespace

Adjusted adjust_session(const JoinedSession& joined,
                        const Map& map,
                        const MapOptions& options,
                        const Progress& progress) {
  constexpr double kGateSigmas = 4.3;  // 2 degrees of freedom, p = 1e-4
  const bool map_stays = options.adjust == SessionAdjust::kNone;
  Adjusted adjusted;
  adjusted.T_map_vehicle = joined.T_map_vehicle;
  adjusted.tracks = joined.tracks;
  const auto judge_tracks = [&](double median_px) {
    if (map_stays)
      drop_views_off_landmarks(joined, adjusted.T_map_vehicle, map,
                               kGateSigmas * sigma_of_median_px(median_px), adjusted.tracks);
    else
      split_tracks_of_session(joined, adjusted.T_map_vehicle, median_px, options, adjusted.tracks);
  };
  judge_tracks(options.bundle.feature_sigma_px);
  const std::vector<bool> free = free_poses(joined, adjusted.tracks, options.adjust);
  const std::vector<std::size_t> chosen = tracks_of(adjusted.tracks, free);
  std::vector<JoinedTrack> tracks;
  for (const std::size_t t : chosen) tracks.push_back(adjusted.tracks[t]);

  BundleStageOptions stage_options = options.bundle;
  stage_options.bundle.num_threads = options.num_threads;
  // Poses that stay cost nothing, however many passes they are of.
  if (options.adjust != SessionAdjust::kAll) stage_options.passes_together = 0;
  adjusted.stage = make_bundle(joined.input, joined.T_map_vehicle, tracks, stage_options);
  BundleProblem& problem = adjusted.stage.problem;
  for (std::size_t k = 0; k < free.size(); ++k) problem.poses[k].fixed = !free[k];
  fix_lone_pieces(joined, problem);
  std::erase_if(problem.motions, [&](const MotionConstraint& motion) {
    return problem.poses[at(motion.from)].fixed && problem.poses[at(motion.to)].fixed;
  });
  const std::vector<int> landmarks = landmarks_of_tracks(map, tracks);
  if (options.adjust == SessionAdjust::kAll)
    add_gauge(joined, problem);
  else
    thin_fixed_views(problem);
  if (map_stays) fix_landmarks(map, landmarks, adjusted.stage);
  // The poses begin where localisation and the earlier adjustments put them: near the end.
  stage_options.bundle.relative_tolerance = 1e-4;
  stage_options.bundle.outlier_rounds = 1;
  adjusted.result =
      options.equal_rows && options.adjust == SessionAdjust::kAll
          ? bundle_adjust_with_rows(problem, options.equal_rows(map), stage_options.bundle,
                                    options.row_options, adjusted.rows, progress)
          : bundle_adjust(problem, stage_options.bundle, progress);
  if (!adjusted.result.usable)
    throw Refused("error: bundle adjustment: got " + adjusted.result.message + ", want a solution");
  for (std::size_t k = 0; k < free.size(); ++k)
    if (free[k]) adjusted.T_map_vehicle[k] = problem.poses[k].T_map_vehicle;

  // Points that took part have adjusted positions, which are better than triangulated ones.
  triangulate_tracks(joined.input, adjusted.T_map_vehicle, options.triangulation, tracks);
  const auto places = adjusted_places(adjusted.stage, adjusted.result.point_kept, tracks.size());
  for (std::size_t t = 0; t < places.size(); ++t)
    if (places[t]) tracks[t].p_map = places[t];
  for (std::size_t i = 0; i < chosen.size(); ++i)
    if (!map_stays || landmarks[i] < 0) adjusted.tracks[chosen[i]] = std::move(tracks[i]);
  for (int& track : adjusted.stage.track_of_point) track = static_cast<int>(chosen[at(track)]);
  judge_tracks(adjusted.result.reprojection_median_px);
  return adjusted;
}

void add_covariances_of_session(const JoinedSession& joined,
                                std::vector<CameraDoubt> doubts,
                                const MapOptions& options,
                                Adjusted& adjusted) {
  if (!options.covariances) return;
  if (options.adjust != SessionAdjust::kAll) {
    add_landmark_covariances(joined, options, adjusted);
    return;
  }
  Relaxed relaxed;
  relaxed.T_map_vehicle = adjusted.T_map_vehicle;
  relaxed.component = joined.piece;
  adjusted.stage.problem.priors.clear();  // the gauge of covariances is the first keyframe
  for (BundlePose& pose : adjusted.stage.problem.poses) pose.fixed = false;
  for (CameraDoubt& doubt : doubts)
    doubt.session = static_cast<int>(joined.input.half_rigs.size()) - 1;
  add_covariances(joined.input, relaxed, common_errors_of(doubts, joined.input, adjusted.stage),
                  options, adjusted);
}

std::string gauge_of(SessionAdjust adjust) {
  switch (adjust) {
    case SessionAdjust::kNear:
      return "poses of the map away from the last session fixed";
    case SessionAdjust::kAll:
      return "weak prior on the poses of the first session";
    case SessionAdjust::kNone:
      return "all poses and landmarks before the last session fixed";
  }
  return {};
}

Adjusted session_alone(const JoinedSession& joined, const Adjusted& adjusted) {
  Adjusted alone;
  const auto first = static_cast<std::ptrdiff_t>(joined.first_keyframe);
  alone.T_map_vehicle.assign(adjusted.T_map_vehicle.begin() + first, adjusted.T_map_vehicle.end());
  const int camera_base = adjusted.stage.camera_base.back();
  const BundleProblem& all = adjusted.stage.problem;
  alone.stage.camera_base = {0};
  alone.stage.scale_of_session = {adjusted.stage.scale_of_session.back()};
  alone.stage.problem.cameras.assign(all.cameras.begin() + camera_base, all.cameras.end());
  alone.stage.problem.poses.assign(
      all.poses.begin() + first,
      all.poses.begin() + static_cast<std::ptrdiff_t>(joined.T_map_vehicle.size()));
  alone.stage.problem.points = all.points;
  alone.result = adjusted.result;
  alone.result.inlier.clear();
  for (std::size_t i = 0; i < all.observations.size(); ++i) {
    BundleObservation view = all.observations[i];
    if (at(view.pose) < joined.first_keyframe) continue;
    view.pose -= static_cast<int>(joined.first_keyframe);
    view.camera -= camera_base;
    alone.stage.problem.observations.push_back(view);
    alone.result.inlier.push_back(adjusted.result.inlier[i]);
  }
  return alone;
}

}  // namespace roadbook
