#include "mapping/pipeline/map_stages.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "mapping/landmark_descriptor.hpp"
#include "mapping/lone_corners.hpp"
#include "mapping/loops/graph_loops.hpp"
#include "mapping/optimisation/graph_relaxation.hpp"
#include "mapping/optimisation/pose_graph_solver.hpp"
#include "mapping/pipeline/track_agreement.hpp"
#include "mapping/travelled.hpp"

namespace roadbook {
namespace {

constexpr double kBundleTolerance = 1e-4;
// Times the gate of loops in the pose graph: poses between loops are less sure than those at them.
constexpr double kGateOutsideGraph = 4.0;

RelativePose motion_of(const LoopEdge& edge) {
  return {edge.from, edge.to, edge.T_from_to, edge.information};
}

std::vector<Eigen::Isometry3d> odometry_poses(const VoResult& odometry) {
  std::vector<Eigen::Isometry3d> poses;
  poses.reserve(odometry.keyframes.size());
  for (const auto& k : odometry.keyframes) poses.push_back(k.T_odom_vehicle);
  return poses;
}

std::vector<TrackMatch> joined_by_loops(const VoResult& odometry,
                                        const std::vector<LoopClosure>& loops) {
  std::vector<TrackMatch> same;
  for (const auto& loop : loops) {
    if (!loop.edge.accepted) continue;
    const VoKeyframe& from = odometry.keyframes[static_cast<std::size_t>(loop.edge.from)];
    for (const auto& m : loop.matches) {
      const int track = from.tracks[static_cast<std::size_t>(m.from_camera)]
                                   [static_cast<std::size_t>(m.from_feature)];
      if (track >= 0) same.push_back({track, {loop.edge.to, m.to_camera, m.to_feature}});
    }
  }
  return same;
}

// Tracks of one landmark: found again at the poses, in loops, and given.
std::vector<TrackMatch> same_tracks(const MappingInput& input,
                                    const std::vector<LoopClosure>& loops,
                                    const Relaxed& relaxed,
                                    const MapOptions& options,
                                    const AdjustTerms& terms,
                                    const std::vector<Eigen::Isometry3d>& T_map_vehicle) {
  auto same = match_revisits(input, T_map_vehicle, relaxed.component, options.revisits);
  if (terms.may_join)
    std::erase_if(same, [&](const TrackMatch& match) {
      const auto& track = input.odometry.tracks[static_cast<std::size_t>(match.track)];
      return std::any_of(track.observations.begin(), track.observations.end(), [&](const auto& o) {
        return !terms.may_join(o.keyframe, match.view.keyframe);
      });
    });
  const auto from_loops = joined_by_loops(input.odometry, loops);
  same.insert(same.end(), from_loops.begin(), from_loops.end());
  same.insert(same.end(), terms.same.begin(), terms.same.end());
  return same;
}

void rechain(VoResult& odometry,
             std::size_t begin,
             std::size_t end,
             const std::vector<double>& factor) {
  const std::vector<Eigen::Isometry3d> before = odometry_poses(odometry);
  for (std::size_t k = begin + 1; k < end; ++k) {
    VoKeyframe& keyframe = odometry.keyframes[k];
    Eigen::Isometry3d T = before[k - 1].inverse() * before[k];
    T.translation() *= factor[k - 1];
    keyframe.T_odom_vehicle = odometry.keyframes[k - 1].T_odom_vehicle * T;
    keyframe.travelled_m = odometry.keyframes[k - 1].travelled_m + T.translation().norm();
    if (keyframe.ground_log_scale) *keyframe.ground_log_scale -= std::log(factor[k - 1]);
    keyframe.information.topLeftCorner<3, 3>() /= factor[k - 1] * factor[k - 1];
    keyframe.information.topRightCorner<3, 3>() /= factor[k - 1];
    keyframe.information.bottomLeftCorner<3, 3>() /= factor[k - 1];
  }
}

// Map frames and keyframes alone; all in one piece.
Map map_of_poses(const MappingInput& input, const Adjusted& adjusted) {
  Map map;
  const auto& keyframes = input.odometry.keyframes;
  const auto travelled_m = travelled_distances(input, adjusted.T_map_vehicle);
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    map.map_frames.push_back({adjusted.T_map_vehicle[k]});
    Keyframe keyframe;
    keyframe.session = input.session[k];
    keyframe.t_ns = keyframes[k].t_ns;
    keyframe.drive_frame = static_cast<int>(keyframes[k].frame);
    keyframe.map_frame = static_cast<int>(k);
    if (adjusted.covariance.usable) keyframe.covariance = adjusted.covariance.poses[k];
    keyframe.travelled_m = travelled_m[k];
    keyframe.reversing = keyframes[k].reversing;
    keyframe.after_gap = keyframes[k].after_gap;
    keyframe.wheels = keyframes[k].wheels;
    map.keyframes.push_back(keyframe);
  }
  return map;
}

void split_wrong_joins_of(const MappingInput& input,
                          const MapOptions& options,
                          Adjusted& adjusted) {
  split_wrong_joins(input, adjusted.T_map_vehicle, adjusted.result.reprojection_median_px, options,
                    adjusted.tracks);
}

// The part of each pose of the problem. Poses behind those of keyframes are of rows of spaces, in
// the part of a pose that a motion ties them to.
std::vector<int> pieces_of(const BundleProblem& problem, const Relaxed& relaxed) {
  std::vector<int> pieces = relaxed.component;
  const std::size_t keyframes = pieces.size();
  pieces.resize(problem.poses.size(), -1);
  // A row's line is tied to its spaces, these to keyframes: two passes reach all.
  for (int pass = 0; pass < 2; ++pass)
    for (const MotionConstraint& motion : problem.motions)
      for (const auto& [known, tied] :
           {std::pair(motion.from, motion.to), std::pair(motion.to, motion.from)}) {
        const auto t = static_cast<std::size_t>(tied);
        if (t >= keyframes && pieces[t] < 0) pieces[t] = pieces[static_cast<std::size_t>(known)];
      }
  for (int& piece : pieces) piece = std::max(piece, 0);
  return pieces;
}

}  // namespace

MappingInput join_drives(std::vector<VoResult> odometry,
                         const std::vector<Rig>& rigs,
                         const std::vector<bool>& has_wheels) {
  MappingInput input;
  for (std::size_t s = 0; s < odometry.size(); ++s) {
    input.half_rigs.push_back(half_size(rigs[s]));
    input.has_wheels.push_back(has_wheels[s]);
    const int first_keyframe = static_cast<int>(input.odometry.keyframes.size());
    const int first_track = static_cast<int>(input.odometry.tracks.size());
    for (auto& keyframe : odometry[s].keyframes) {
      for (auto& tracks : keyframe.tracks)
        for (int& id : tracks) id += id >= 0 ? first_track : 0;
      input.odometry.keyframes.push_back(std::move(keyframe));
      input.session.push_back(static_cast<int>(s));
    }
    if (s > 0 && first_keyframe < static_cast<int>(input.odometry.keyframes.size()))
      input.odometry.keyframes[static_cast<std::size_t>(first_keyframe)].after_gap = true;
    for (auto& track : odometry[s].tracks) {
      for (auto& o : track.observations) o.keyframe += first_keyframe;
      input.odometry.tracks.push_back(std::move(track));
    }
    odometry[s] = {};
  }
  return input;
}

bool has_motion_without_wheels(const MappingInput& input, int session) {
  const auto& keyframes = input.odometry.keyframes;
  for (std::size_t k = 1; k < keyframes.size(); ++k)
    if (input.session[k] == session && !keyframes[k].after_gap && !keyframes[k].wheels) return true;
  return false;
}

std::optional<double> scale_by_ground(MappingInput& input, int session, const MapOptions& options) {
  std::optional<double> sigma;
  // Triangulation and the choice of ground points depend on the scale, so a second round is needed.
  for (int round = 0; round < 2; ++round) {
    const auto poses = odometry_poses(input.odometry);
    auto tracks = join_tracks(input.odometry, {});
    triangulate_tracks(input, poses, options.triangulation, tracks);
    auto profile = ground_scale_profile(input, poses, tracks);
    if (!profile.found) break;
    std::size_t begin = 0;
    while (begin < poses.size() && input.session[begin] != session) ++begin;
    std::size_t end = begin;
    while (end < poses.size() && input.session[end] == session) ++end;
    sigma = largest_sigma(profile, begin, end);
    // Where the wheels know the motion, they know its length better.
    for (std::size_t k = begin + 1; k < end; ++k)
      if (input.odometry.keyframes[k].wheels) profile.factor[k - 1] = 1.0;
    rechain(input.odometry, begin, end, profile.factor);
  }
  const auto poses = odometry_poses(input.odometry);
  const auto places = triangulate_odometry_tracks(input, poses, options.triangulation);
  for (std::size_t t = 0; t < places.size(); ++t) input.odometry.tracks[t].p_odom = places[t];
  return sigma;
}

Relaxed relax_poses(const MappingInput& input,
                    std::vector<LoopClosure>& loops,
                    const MapOptions& options,
                    const Progress& progress) {
  const auto& keyframes = input.odometry.keyframes;
  PoseGraph graph;
  graph.T_map_vehicle = odometry_poses(input.odometry);
  for (std::size_t k = 1; k < keyframes.size(); ++k)
    if (!keyframes[k].after_gap)
      graph.odometry.push_back(
          {static_cast<int>(k) - 1, static_cast<int>(k),
           keyframes[k - 1].T_odom_vehicle.inverse() * keyframes[k].T_odom_vehicle,
           keyframes[k].information});
  const std::vector<std::size_t> in_graph = loops_of_graph(loops, segments_of(keyframes));
  for (const std::size_t i : in_graph) graph.loops.push_back(motion_of(loops[i].edge));
  const auto result = relax(graph, options.graph, progress);
  if (!result.usable)
    throw Refused("error: pose graph: got " + result.message + ", want a solution");
  std::vector<std::uint8_t> agrees(loops.size(), 0);
  const GraphState state{result.T_map_vehicle, {}, {}};
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const LoopEdge& edge = loops[i].edge;
    agrees[i] = result.component[static_cast<std::size_t>(edge.from)] ==
                    result.component[static_cast<std::size_t>(edge.to)] &&
                edge_chi2(motion_of(loops[i].edge), state) <=
                    kGateOutsideGraph * options.graph.max_loop_chi2;
    loops[i].edge.weight = loops[i].edge.accepted && agrees[i] != 0 ? 1.0 : 0.0;
  }
  for (std::size_t i = 0; i < in_graph.size(); ++i) {
    loops[in_graph[i]].edge.weight = result.loop_weights[i];
    agrees[in_graph[i]] = result.loop_accepted[i];
  }
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (!loops[i].edge.accepted || agrees[i] != 0) continue;
    loops[i].edge.accepted = false;
    loops[i].edge.reason = "contradicts odometry and the other loops";
  }
  return {result.T_map_vehicle, result.component, result.components};
}

Adjusted adjust(const MappingInput& input,
                const std::vector<LoopClosure>& loops,
                const Relaxed& relaxed,
                const MapOptions& options,
                const Progress& progress,
                const AdjustTerms& terms) {
  Adjusted adjusted;
  adjusted.T_map_vehicle = relaxed.T_map_vehicle;
  BundleStageOptions stage_options = options.bundle;
  stage_options.bundle.num_threads = options.num_threads;
  const auto need_descriptors = [&](bool needed) {
    if (terms.need_descriptors) terms.need_descriptors(needed);
  };
  // Two rounds: with the poses of the first, more tracks are found again in other passes.
  for (int round = 0; round < 2; ++round) {
    need_descriptors(true);
    adjusted.stage = {};
    adjusted.tracks = join_tracks(
        input.odometry, same_tracks(input, loops, relaxed, options, terms, adjusted.T_map_vehicle));
    triangulate_tracks(input, adjusted.T_map_vehicle, options.triangulation, adjusted.tracks);
    if (round > 0) split_wrong_joins_of(input, options, adjusted);
    adjusted.stage = make_bundle(input, adjusted.T_map_vehicle, adjusted.tracks, stage_options);
    need_descriptors(false);
    auto& problem = adjusted.stage.problem;
    problem.priors = terms.priors;
    problem.motions.insert(problem.motions.end(), terms.motions.begin(), terms.motions.end());
    // A looser tolerance changes poses by less than a tenth of their standard deviation and saves
    // most of the iterations (docs/results/speed.md).
    stage_options.bundle.relative_tolerance = kBundleTolerance;
    stage_options.bundle.max_iterations = round == 0 ? 6 : options.bundle.bundle.max_iterations;
    stage_options.bundle.outlier_rounds = round;  // in the first round the robust loss is enough
    adjusted.result =
        round == 1 && options.equal_rows
            ? bundle_adjust_with_rows(
                  adjusted.stage.problem, options.equal_rows(map_of_poses(input, adjusted)),
                  stage_options.bundle, options.row_options, adjusted.rows, progress)
            : bundle_adjust(adjusted.stage.problem, stage_options.bundle, progress);
    if (!adjusted.result.usable)
      throw Refused("error: bundle adjustment: got " + adjusted.result.message +
                    ", want a solution");
    for (std::size_t k = 0; k < adjusted.T_map_vehicle.size(); ++k)
      adjusted.T_map_vehicle[k] = adjusted.stage.problem.poses[k].T_map_vehicle;
  }
  triangulate_tracks(input, adjusted.T_map_vehicle, options.triangulation, adjusted.tracks);
  // Adjusted positions are better than triangulated ones.
  const auto places =
      adjusted_places(adjusted.stage, adjusted.result.point_kept, adjusted.tracks.size());
  for (std::size_t t = 0; t < places.size(); ++t)
    if (places[t]) adjusted.tracks[t].p_map = places[t];
  split_wrong_joins_of(input, options, adjusted);
  return adjusted;
}

void add_covariances(const MappingInput& input,
                     const Relaxed& relaxed,
                     const std::vector<CommonError>& suspected,
                     const MapOptions& options,
                     Adjusted& adjusted) {
  if (!options.covariances) return;
  BundleOptions bundle = options.bundle.bundle;
  bundle.num_threads = options.num_threads;
  adjusted.covariance =
      cluster_covariance(adjusted.stage.problem, adjusted.result.inlier,
                         pieces_of(adjusted.stage.problem, relaxed), bundle, {}, suspected);
  adjusted.landmark_covariance =
      landmark_covariances(input, adjusted.T_map_vehicle, adjusted.tracks,
                           options.bundle.feature_sigma_px, options.triangulation);
}

void split_wrong_joins(const MappingInput& input,
                       const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                       double reprojection_median_px,
                       const MapOptions& options,
                       std::vector<JoinedTrack>& tracks) {
  AgreementOptions agreement;
  agreement.sigma_px = sigma_of_median_px(reprojection_median_px);
  agreement.triangulation = options.triangulation;
  agreement.num_threads = options.num_threads;
  split_disagreeing_tracks(input, T_map_vehicle, agreement, tracks);
}

Descriptor descriptor_of(const MappingInput& input, const JoinedTrack& track) {
  std::vector<Descriptor> seen;
  for (const KeyPointId& view : track.views)
    seen.push_back(input.odometry.keyframes[static_cast<std::size_t>(view.keyframe)]
                       .features[static_cast<std::size_t>(view.camera)]
                       .descriptors[static_cast<std::size_t>(view.feature)]);
  return seen[middle_descriptor(seen)];
}

Map map_of_stages(const MappingInput& input,
                  const std::vector<LoopClosure>& loops,
                  const Adjusted& adjusted,
                  const MapOptions& options) {
  Map map = map_of_poses(input, adjusted);
  for (const auto& loop : loops) map.loops.push_back(loop.edge);

  const auto views =
      view_from_above(input, adjusted.T_map_vehicle, adjusted.tracks, options.bundle.ground);
  const double level = ground_level(views, options.bundle.ground);
  for (std::size_t t = 0; t < adjusted.tracks.size(); ++t) {
    const JoinedTrack& track = adjusted.tracks[t];
    if (!track.p_map || static_cast<int>(track.views.size()) < options.min_views) continue;
    const KeyPointId& first = track.views.front();
    Landmark landmark;
    landmark.map_frame = first.keyframe;
    landmark.p_frame =
        adjusted.T_map_vehicle[static_cast<std::size_t>(first.keyframe)].inverse() * *track.p_map;
    landmark.descriptor = descriptor_of(input, track);
    landmark.ground = on_ground(views[t], level, options.bundle.ground);
    if (!adjusted.landmark_covariance.of_track.empty())
      landmark.covariance = adjusted.landmark_covariance.of_track[t];
    const int id = static_cast<int>(map.landmarks.size());
    map.landmarks.push_back(landmark);
    for (const auto& view : track.views) {
      const Eigen::Vector2d pixel = full_size_pixel(input.pixel(view));
      map.observations.push_back(
          {id, view.keyframe, view.camera, pixel.cast<float>(),
           static_cast<float>(kFullPerHalfPixel * options.bundle.feature_sigma_px)});
    }
  }
  std::stable_sort(map.observations.begin(), map.observations.end(),
                   [](const Observation& a, const Observation& b) {
                     return std::pair(a.keyframe, a.camera) < std::pair(b.keyframe, b.camera);
                   });
  map.corners = lone_corners(input, adjusted.tracks, options.min_views);
  return map;
}

}  // namespace roadbook
