#include "mapping/sessions/place_session.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/error.hpp"
#include "base/index.hpp"
#include "mapping/optimisation/graph_relaxation.hpp"
#include "mapping/pieces.hpp"

namespace roadbook {
namespace {

// A place that many sessions have passed has more keyframes and landmarks than a pose needs: those
// near to it stay, and landmarks with the most views from there. So the time of a keyframe does not
// grow with the sessions.
NearLandmarksOptions near_in(const Map& map) {
  constexpr std::size_t kMostLandmarks = 1200;
  constexpr double kReachOfOneM = 8.0;
  constexpr double kLeastReachM = 1.5;
  NearLandmarksOptions near;
  near.max_landmarks = kMostLandmarks;
  near.reach_m = std::clamp(kReachOfOneM / static_cast<double>(map.sessions.size()), kLeastReachM,
                            near.reach_m);
  return near;
}

// The motion between two keyframes by odometry, as a prediction. Empty where it is not known.
std::optional<PlanarMotion> predicted_motion(const VoKeyframe& from, const VoKeyframe& to) {
  if (to.after_gap) return std::nullopt;
  const Eigen::Isometry3d T = from.T_odom_vehicle.inverse() * to.T_odom_vehicle;
  const Eigen::LLT<Matrix6d> llt(to.information);
  if (llt.info() != Eigen::Success) return to.wheels;
  const Matrix6d covariance = llt.solve(Matrix6d::Identity());
  const std::array<Eigen::Index, 3> planar{0, 1, 5};
  PlanarMotion motion;
  motion.motion = {T.translation().x(), T.translation().y(), heading_of(T)};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c)
      motion.covariance(index(r), index(c)) = covariance(planar[r], planar[c]);
  motion.distance_m = T.translation().head<2>().norm();
  motion.reversing = to.reversing;
  return motion;
}

// Localises the keyframes one after another. Those before the first confirmed pose stay without a
// fix unless they waited for it.
std::vector<LocalisedFrame> localise_keyframes(const MappingInput& drive,
                                               bool is_metric,
                                               const LandmarkIndex& index,
                                               const Progress& progress) {
  const auto& keyframes = drive.odometry.keyframes;
  LocaliserOptions options;
  options.fix.near = near_in(index.map());
  Localiser localiser(index, drive.half_rigs.front(), options);
  std::vector<LocalisedFrame> localised;
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    LocaliserFrame frame;
    frame.frame = k;
    frame.t_ns = keyframes[k].t_ns;
    frame.features = keyframes[k].features;
    if (k > 0 && is_metric) frame.wheels = predicted_motion(keyframes[k - 1], keyframes[k]);
    localised.push_back(localiser.add(std::move(frame)));
    if (localiser.confirmed())
      for (std::size_t i = localised.size() - 1; i-- > 0 && localised[i].tentative;)
        localised[i].tentative = false;
    report(progress, "localise", k + 1, keyframes.size());
  }
  return localised;
}

bool has_fix(const LocalisedFrame& frame) { return !frame.tentative && frame.inliers > 0; }

// The piece of the map in which most keyframes are localised.
int main_piece(const std::vector<LocalisedFrame>& localised, const Map& map) {
  std::map<int, int> count;
  for (const LocalisedFrame& frame : localised)
    if (has_fix(frame) && frame.keyframe >= 0) ++count[map.keyframes[at(frame.keyframe)].piece];
  int best = 0;
  int most = 0;
  for (const auto& [piece, keyframes] : count)
    if (keyframes > most) {
      most = keyframes;
      best = piece;
    }
  return best;
}

// Stretches without a fix that are long enough to need loops within the drive.
bool has_new_ground(const MappingInput& drive, const std::vector<LocalisedFrame>& localised) {
  constexpr double kLongM = 10.0;
  const auto& keyframes = drive.odometry.keyframes;
  double since_m = keyframes.front().travelled_m;
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    if (has_fix(localised[k])) since_m = keyframes[k].travelled_m;
    if (keyframes[k].travelled_m - since_m > kLongM) return true;
  }
  return false;
}

// Node 0 is the map, keyframe k is node k + 1. A stretch of odometry begins where its first fix
// puts it, or where the stretch before it puts it.
std::vector<Eigen::Isometry3d> start_poses(const MappingInput& drive,
                                           const std::vector<LocalisedFrame>& localised) {
  const auto& keyframes = drive.odometry.keyframes;
  std::vector<Eigen::Isometry3d> poses{Eigen::Isometry3d::Identity()};
  Eigen::Isometry3d T_map_odom = Eigen::Isometry3d::Identity();
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    if (k == 0 || keyframes[k].after_gap)
      for (std::size_t i = k; i < keyframes.size() && (i == k || !keyframes[i].after_gap); ++i)
        if (has_fix(localised[i])) {
          T_map_odom = localised[i].T_map_vehicle * keyframes[i].T_odom_vehicle.inverse();
          break;
        }
    poses.push_back(T_map_odom * keyframes[k].T_odom_vehicle);
  }
  return poses;
}

// Covariances of keyframes without a fix: that of the nearest one with a fix, grown along the
// odometry. Forwards, then backwards for those before the first fix.
void add_covariances_between(const MappingInput& drive, std::vector<PlacedKeyframe>& placed) {
  const auto& keyframes = drive.odometry.keyframes;
  const auto motion_covariance = [&](std::size_t k) -> std::optional<Matrix6d> {
    if (keyframes[k].after_gap) return std::nullopt;
    const Eigen::LLT<Matrix6d> llt(keyframes[k].information);
    if (llt.info() != Eigen::Success) return std::nullopt;
    return Matrix6d(llt.solve(Matrix6d::Identity()));
  };
  for (std::size_t k = 1; k < placed.size(); ++k) {
    if (is_known(placed[k].covariance) || !is_known(placed[k - 1].covariance)) continue;
    if (const auto motion = motion_covariance(k))
      placed[k].covariance = compose_covariance(
          placed[k - 1].covariance, placed[k - 1].T_map_vehicle.inverse() * placed[k].T_map_vehicle,
          *motion);
  }
  for (std::size_t k = placed.size() - 1; k-- > 0;) {
    if (is_known(placed[k].covariance) || !is_known(placed[k + 1].covariance)) continue;
    if (const auto motion = motion_covariance(k + 1))
      placed[k].covariance = compose_covariance(
          placed[k + 1].covariance, placed[k + 1].T_map_vehicle.inverse() * placed[k].T_map_vehicle,
          *motion);
  }
}

// Keyframes that the localiser passed by, such as the first ones, before it knew the place: their
// relaxed poses tell where to look for landmarks.
void localise_rest(const MappingInput& drive,
                   const LandmarkIndex& index,
                   int piece,
                   PlacedSession& session) {
  constexpr double kWithinM = 0.3;  // standard deviations of the relaxed poses
  constexpr double kWithinRad = 0.02;
  const Rig& rig = drive.half_rigs.front();
  FrameFixOptions options;
  options.near = near_in(index.map());
  options.use_prior = false;
  Matrix6d covariance = Matrix6d::Zero();
  covariance.diagonal() << Eigen::Vector3d::Constant(kWithinM * kWithinM),
      Eigen::Vector3d::Constant(kWithinRad * kWithinRad);
  for (std::size_t k = 0; k < session.keyframes.size(); ++k) {
    PlacedKeyframe& placed = session.keyframes[k];
    if (placed.is_localised || placed.piece != piece) continue;
    const FrameCorners corners(rig, drive.odometry.keyframes[k].features);
    std::vector<int> in_view;
    auto fix =
        fix_frame(rig, corners, index, {placed.T_map_vehicle, covariance}, options, &in_view);
    if (!fix || !has_enough(*fix, rig, options)) continue;
    const Eigen::Isometry3d jump = placed.T_map_vehicle.inverse() * fix->T_map_vehicle;
    const int near = index.nearest_keyframe(fix->T_map_vehicle.translation());
    if (jump.translation().norm() > 2.0 * kWithinM || near < 0 ||
        so3_log(jump.linear()).norm() > 2.0 * kWithinRad)
      continue;
    placed.is_localised = true;
    placed.near = near;
    placed.T_map_vehicle = fix->T_map_vehicle;
    placed.covariance = compose_covariance(
        index.map().keyframes[at(near)].covariance,
        index.map().T_map_vehicle(near).inverse() * fix->T_map_vehicle, fix->covariance);
    placed.views = std::move(fix->views);
    placed.in_view = std::move(in_view);
    ++session.localised;
  }
}

}  // namespace

PlacedSession place_session(const MappingInput& drive,
                            bool is_metric,
                            const LandmarkIndex& index,
                            const MapOptions& options,
                            const Progress& progress) {
  // Successive fixes see the same landmarks: together they count less than each alone.
  constexpr double kShareOfFix = 0.25;
  const Map& map = index.map();
  const auto& keyframes = drive.odometry.keyframes;
  auto localised = localise_keyframes(drive, is_metric, index, progress);
  const int piece = main_piece(localised, map);

  PlacedSession session;
  if (has_new_ground(drive, localised)) {
    LoopOptions loops = options.loops;
    loops.num_threads = options.num_threads;
    session.loops = find_loops(drive, loops, progress);
  }
  PoseGraph graph;
  graph.T_map_vehicle = start_poses(drive, localised);
  for (std::size_t k = 1; k < keyframes.size(); ++k)
    if (!keyframes[k].after_gap)
      graph.odometry.push_back(
          {static_cast<int>(k), static_cast<int>(k) + 1,
           keyframes[k - 1].T_odom_vehicle.inverse() * keyframes[k].T_odom_vehicle,
           keyframes[k].information});
  std::vector<std::size_t> fixed;  // keyframes of the first loops of the graph
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    if (!has_fix(localised[k]) || localised[k].keyframe < 0) continue;
    if (map.keyframes[at(localised[k].keyframe)].piece != piece) {
      ++session.other_pieces;
      continue;
    }
    const Eigen::LLT<Matrix6d> llt(localised[k].local_covariance);
    if (llt.info() != Eigen::Success) continue;
    fixed.push_back(k);
    graph.loops.push_back({0, static_cast<int>(k) + 1, localised[k].T_map_vehicle,
                           kShareOfFix * llt.solve(Matrix6d::Identity())});
  }
  std::vector<std::size_t> loops_in_graph;
  for (std::size_t i = 0; i < session.loops.size(); ++i) {
    const LoopEdge& edge = session.loops[i].edge;
    if (!edge.accepted) continue;
    loops_in_graph.push_back(i);
    graph.loops.push_back({edge.from + 1, edge.to + 1, edge.T_from_to, edge.information});
  }
  const auto relaxed = relax(graph, options.graph, progress);
  if (!relaxed.usable)
    throw Refused("error: pose graph: got " + relaxed.message + ", want a solution");
  for (std::size_t i = 0; i < loops_in_graph.size(); ++i) {
    LoopEdge& edge = session.loops[loops_in_graph[i]].edge;
    edge.weight = relaxed.loop_weights[fixed.size() + i];
    if (relaxed.loop_accepted[fixed.size() + i]) continue;
    edge.accepted = false;
    edge.reason = "contradicts odometry and the other loops";
  }

  session.keyframes.resize(keyframes.size());
  std::map<int, int> new_pieces;  // of components that nothing joins to the map
  const int first_new = piece_count(map);
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    PlacedKeyframe& placed = session.keyframes[k];
    placed.T_map_vehicle = relaxed.T_map_vehicle[k + 1];
    const int component = relaxed.component[k + 1];
    if (component == relaxed.component.front()) {
      placed.piece = piece;
      ++session.joined;
    } else {
      placed.piece =
          new_pieces.try_emplace(component, first_new + static_cast<int>(new_pieces.size()))
              .first->second;
    }
  }
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    if (!relaxed.loop_accepted[i]) continue;
    LocalisedFrame& frame = localised[fixed[i]];
    PlacedKeyframe& placed = session.keyframes[fixed[i]];
    placed.is_localised = true;
    placed.covariance = frame.covariance;
    placed.near = frame.keyframe;
    placed.views = std::move(frame.views);
    placed.in_view = std::move(frame.in_view);
    ++session.localised;
  }
  if (session.localised > 0) localise_rest(drive, index, piece, session);
  add_covariances_between(drive, session.keyframes);
  return session;
}

}  // namespace roadbook
