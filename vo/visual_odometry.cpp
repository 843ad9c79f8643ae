#include "vo/visual_odometry.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/error.hpp"
#include "vo/ground_scale.hpp"
#include "vo/rig_pose.hpp"
#include "vo/track_matching.hpp"
#include "vo/triangulation.hpp"
#include "vo/two_view.hpp"

namespace roadbook {
namespace {

constexpr double kFirstRadiusPx = 20.0;     // search without knowledge of the motion but constancy
constexpr double kPredictedRadiusPx = 6.0;  // search where the wheels predict the motion
constexpr double kRefinedRadiusPx = 3.5;    // second search, with the pose of the first
constexpr double kUnknownRadiusPx = 60.0;   // search for the first motion of all
constexpr double kFirstFlowPx = 4.0;        // median motion of corners that tells a first motion
constexpr std::size_t kFewestPairs = 30;    // corners found again, to tell a first motion
constexpr double kLostSeconds = 0.5;        // without them: a new start
constexpr double kGuessedSpeed = 5.0;       // [m/s] until the ground tells the scale
constexpr std::size_t kMaxRays = 10;        // of a track, for triangulation

std::vector<FeatureGrid> make_grids(const std::vector<Features>& features, const Rig& rig) {
  std::vector<FeatureGrid> grids;
  grids.reserve(features.size());
  for (std::size_t c = 0; c < features.size(); ++c)
    grids.emplace_back(features[c].pixels, rig.cameras[c].camera.width,
                       rig.cameras[c].camera.height);
  return grids;
}

// What holds for any car without wheels' odometry: it neither slides sideways nor hops, and tilts
// little from one frame to the next. Speed and turn stay free.
Matrix6d driving_information(double distance_m) {
  const double sigma_side = 0.02 + 0.05 * distance_m;
  constexpr double kSigmaTilt = 0.02;
  Matrix6d information = Matrix6d::Zero();
  const double sigma_up = 2.0 * sigma_side;  // slopes, and the pitch of the camera's mount
  information(1, 1) = 1.0 / (sigma_side * sigma_side);
  information(2, 2) = 1.0 / (sigma_up * sigma_up);
  information(3, 3) = information(4, 4) = 1.0 / (kSigmaTilt * kSigmaTilt);
  return information;
}

}  // namespace

void VoOptions::check() const {
  if (!(spacing_m > 0.0)) throw InvalidOption("spacing_m", std::to_string(spacing_m), "> 0");
  if (!(turn_rad > 0.0)) throw InvalidOption("turn_rad", std::to_string(turn_rad), "> 0");
  if (!(feature_sigma_px > 0.0))
    throw InvalidOption("feature_sigma_px", std::to_string(feature_sigma_px), "> 0");
  if (min_inliers < 6) throw InvalidOption("min_inliers", std::to_string(min_inliers), ">= 6");
}

Eigen::Isometry3d planar_transform(const PlanarMotion& motion) {
  return pose_from_planar(motion.motion.x(), motion.motion.y(), motion.motion.z());
}

Matrix6d planar_information(const PlanarMotion& motion) {
  // Out of the plane a car follows the road: it pitches, rolls and climbs a little.
  const double d = motion.distance_m;
  const double sigma_height = 0.005 + 0.05 * d;
  const double sigma_tilt = 0.005 + 0.03 * std::sqrt(d);
  Eigen::Matrix3d planar = motion.covariance;
  planar.diagonal() += Eigen::Vector3d(1e-6, 1e-6, 1e-7);  // a standing car is not known for ever
  // x, y of the covariance stand in the old frame, the perturbation in the new one.
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(-motion.motion.z()).toRotationMatrix();
  const Eigen::Matrix3d information = (R * planar * R.transpose()).inverse();
  Matrix6d full = Matrix6d::Zero();
  constexpr std::array<int, 3> kPlace{0, 1, 5};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      full(kPlace[i], kPlace[j]) = information(static_cast<int>(i), static_cast<int>(j));
  full(2, 2) = 1.0 / (sigma_height * sigma_height);
  full(3, 3) = full(4, 4) = 1.0 / (sigma_tilt * sigma_tilt);
  return full;
}

struct VisualOdometry::State {
  Rig rig;
  VoOptions options;
  VoResult result;
  double tolerance_rad = 0.0;  // the inlier threshold as an angle
  // Per camera: tracks that may be found again.
  std::vector<std::vector<int>> active;
  std::size_t newest_tracks = 0;  // first of those begun in the last keyframe
  // Constant-velocity prediction where there are no wheels.
  Vector6d velocity = Vector6d::Zero();  // per second
  std::int64_t velocity_t_ns = 0;
  std::optional<VoFrame> reference;  // first view, while no motion is known
  bool has_motion = false;

  State(Rig half_rig, const VoOptions& vo_options) : rig(std::move(half_rig)), options(vo_options) {
    options.check();
    double focal = 1e9;
    for (const auto& mounted : rig.cameras) focal = std::min(focal, mounted.camera.focal_px());
    tolerance_rad = options.inlier_px / focal;
    active.resize(rig.cameras.size());
  }

  struct Matches {
    std::vector<std::vector<int>> tracks;    // per camera: active tracks searched for
    std::vector<std::vector<int>> features;  // their feature, or -1
  };

  const VoKeyframe& last() const { return result.keyframes.back(); }

  Eigen::Vector3d bearing_of(int camera, const TrackObservation& o) const {
    const auto c = static_cast<std::size_t>(camera);
    const Eigen::Vector2f& pixel = result.keyframes[static_cast<std::size_t>(o.keyframe)]
                                       .features[c]
                                       .pixels[static_cast<std::size_t>(o.feature)];
    return rig.cameras[c].camera.bearing(pixel.cast<double>()).value_or(Eigen::Vector3d::UnitZ());
  }

  enum class Searched { kKnownPlaces, kAll };
  Matches search(const VoFrame& frame,
                 const std::vector<FeatureGrid>& grids,
                 const Eigen::Isometry3d& T_odom_new,
                 double radius_px,
                 Searched searched) const;
  std::vector<RigObservation> known_points(const VoFrame& frame, const Matches& matches) const;
  void accept(VoFrame&& frame, const Matches& matches, VoKeyframe&& keyframe);
  bool consistent(int track,
                  int camera,
                  const Eigen::Vector2f& pixel,
                  const Eigen::Isometry3d& T_odom_new) const;
  void triangulate_tracks(const VoKeyframe& keyframe);
  void forget_lone_tracks();
  void start_tracks(VoKeyframe& keyframe, std::size_t index);
  void drop_lone_start();
  VoOutcome start_segment(VoFrame&& frame, bool after_gap);
  VoOutcome add_waiting(VoFrame&& frame);
  std::vector<BearingPair> pairs_with(const VoFrame& frame, double& median_flow_px) const;
  std::optional<Eigen::Isometry3d> first_motion(const std::vector<BearingPair>& pairs,
                                                double dt) const;
  VoOutcome add_tracking(VoFrame&& frame, bool is_first_motion);
  std::optional<RigPose> estimate(const VoFrame& frame,
                                  const std::vector<FeatureGrid>& grids,
                                  Matches& matches) const;
  Eigen::Isometry3d predict(const VoFrame& frame) const;
  std::optional<RigPose> estimate_without_places(const VoFrame& frame,
                                                 const std::vector<FeatureGrid>& grids,
                                                 Matches& matches) const;
};

VisualOdometry::State::Matches VisualOdometry::State::search(const VoFrame& frame,
                                                             const std::vector<FeatureGrid>& grids,
                                                             const Eigen::Isometry3d& T_odom_new,
                                                             double radius_px,
                                                             Searched searched) const {
  const Eigen::Isometry3d T_new_odom = T_odom_new.inverse();
  Matches matches;
  matches.tracks = active;
  if (searched == Searched::kKnownPlaces)
    for (auto& tracks : matches.tracks)
      std::erase_if(tracks, [&](int id) {
        return !result.tracks[static_cast<std::size_t>(id)].p_odom.has_value();
      });
  matches.features.resize(active.size());
  for (std::size_t c = 0; c < active.size(); ++c) {
    // Tracks last seen in the same keyframe share one relative motion.
    std::vector<MatchQuery> queries;
    std::vector<int> seen_in;
    for (const int id : matches.tracks[c]) {
      const Track& track = result.tracks[static_cast<std::size_t>(id)];
      const TrackObservation& o = track.observations.back();
      const Features& features = result.keyframes[static_cast<std::size_t>(o.keyframe)].features[c];
      MatchQuery query;
      query.bearing = bearing_of(static_cast<int>(c), o);
      query.pixel = features.pixels[static_cast<std::size_t>(o.feature)];
      query.descriptor = &features.descriptors[static_cast<std::size_t>(o.feature)];
      if (track.p_odom) query.p_vehicle = T_new_odom * *track.p_odom;
      queries.push_back(query);
      seen_in.push_back(o.keyframe);
    }
    matches.features[c].assign(queries.size(), -1);
    std::vector<int> owner(frame.features[c].size(), -1);
    for (int k = static_cast<int>(result.keyframes.size()) - 1;
         k >= 0 && k >= static_cast<int>(result.keyframes.size()) - 1 - options.max_skipped; --k) {
      std::vector<MatchQuery> some;
      std::vector<std::size_t> place;
      for (std::size_t q = 0; q < queries.size(); ++q)
        if (seen_in[q] == k) {
          some.push_back(queries[q]);
          place.push_back(q);
        }
      const Eigen::Isometry3d T_new_old =
          T_new_odom * result.keyframes[static_cast<std::size_t>(k)].T_odom_vehicle;
      const auto found =
          match_queries(rig.cameras[c], T_new_old, some, frame.features[c], grids[c], radius_px);
      for (std::size_t i = 0; i < found.size(); ++i) {
        if (found[i] < 0 || owner[static_cast<std::size_t>(found[i])] >= 0) continue;
        owner[static_cast<std::size_t>(found[i])] = static_cast<int>(place[i]);
        matches.features[c][place[i]] = found[i];
      }
    }
  }
  return matches;
}

std::vector<RigObservation> VisualOdometry::State::known_points(const VoFrame& frame,
                                                                const Matches& matches) const {
  std::vector<RigObservation> points;
  for (std::size_t c = 0; c < matches.tracks.size(); ++c)
    for (std::size_t i = 0; i < matches.tracks[c].size(); ++i) {
      const Track& track = result.tracks[static_cast<std::size_t>(matches.tracks[c][i])];
      const int feature = matches.features[c][i];
      if (feature < 0 || !track.p_odom) continue;
      points.push_back({static_cast<int>(c),
                        frame.features[c].pixels[static_cast<std::size_t>(feature)].cast<double>(),
                        *track.p_odom});
    }
  return points;
}

Eigen::Isometry3d VisualOdometry::State::predict(const VoFrame& frame) const {
  if (frame.wheels) return last().T_odom_vehicle * planar_transform(*frame.wheels);
  const double dt = static_cast<double>(frame.t_ns - last().t_ns) * 1e-9;
  return last().T_odom_vehicle * se3_exp(velocity * dt);
}

std::optional<RigPose> VisualOdometry::State::estimate(const VoFrame& frame,
                                                       const std::vector<FeatureGrid>& grids,
                                                       Matches& matches) const {
  RigPoseOptions pose_options;
  pose_options.sigma_px = options.feature_sigma_px;
  pose_options.inlier_px = options.inlier_px;
  const Eigen::Isometry3d predicted = predict(frame);
  std::optional<RigPosePrior> prior;
  if (frame.wheels)
    // Corners share the errors of the poses they were triangulated with, so that an error of one
    // motion would repeat itself in the next; the wheels know nothing of it.
    prior =
        RigPosePrior{predicted, options.information_discount * planar_information(*frame.wheels)};
  else
    prior = RigPosePrior{
        predicted,
        driving_information((last().T_odom_vehicle.inverse() * predicted).translation().norm())};
  // The pose needs known places alone; the corners without one follow when it is good.
  matches = search(frame, grids, predicted, frame.wheels ? kPredictedRadiusPx : kFirstRadiusPx,
                   Searched::kKnownPlaces);
  auto points = known_points(frame, matches);
  auto pose = refine_rig_pose(rig, points, predicted, prior, pose_options);
  const auto too_few = [&] {
    return !pose ||
           pose->inliers < std::max(options.min_inliers, static_cast<int>(points.size()) / 2);
  };
  if (!frame.wheels && too_few()) {
    const auto found = find_rig_pose(rig, points, pose_options);
    if (found && (!pose || found->inliers > pose->inliers)) pose = found;
  }
  if (!pose || (pose->inliers < options.min_inliers && !frame.wheels)) return std::nullopt;
  if (pose->inliers < options.min_inliers) pose->T_world_vehicle = predicted;
  matches = search(frame, grids, pose->T_world_vehicle, kRefinedRadiusPx, Searched::kAll);
  points = known_points(frame, matches);
  pose_options.iterations = 6;
  auto refined = refine_rig_pose(rig, points, pose->T_world_vehicle, prior, pose_options);
  if (!refined) return std::nullopt;
  if (refined->inliers < options.min_inliers) {
    if (!frame.wheels) return std::nullopt;
    refined->T_world_vehicle = predicted;
    refined->information = prior->information;
  }
  return refined;
}

// The first motion after a start, by wheels and epipolar planes: an error in it would turn every
// corner's place, and with them all the motions that follow.
std::optional<RigPose> VisualOdometry::State::estimate_without_places(
    const VoFrame& frame, const std::vector<FeatureGrid>& grids, Matches& matches) const {
  matches = search(frame, grids, predict(frame), kPredictedRadiusPx, Searched::kAll);
  std::vector<BearingPair> pairs;
  for (std::size_t c = 0; c < matches.tracks.size(); ++c)
    for (std::size_t i = 0; i < matches.tracks[c].size(); ++i) {
      const int feature = matches.features[c][i];
      const auto& seen =
          result.tracks[static_cast<std::size_t>(matches.tracks[c][i])].observations.back();
      if (feature < 0 || seen.keyframe + 1 != static_cast<int>(result.keyframes.size())) continue;
      const Eigen::Vector2f& pixel = frame.features[c].pixels[static_cast<std::size_t>(feature)];
      const auto bearing = rig.cameras[c].camera.bearing(pixel.cast<double>());
      if (bearing)
        pairs.push_back({static_cast<int>(c), bearing_of(static_cast<int>(c), seen), *bearing});
    }
  if (pairs.size() < kFewestPairs) return std::nullopt;
  std::vector<Eigen::Isometry3d> mounts;
  for (const auto& mounted : rig.cameras) mounts.push_back(mounted.T_vehicle_camera);
  const Matrix6d information = planar_information(*frame.wheels);
  const auto T_last_new =
      refine_motion(pairs, mounts, planar_transform(*frame.wheels), information,
                    tolerance_rad * options.feature_sigma_px / options.inlier_px);
  if (!T_last_new) return std::nullopt;
  RigPose pose;
  pose.T_world_vehicle = last().T_odom_vehicle * *T_last_new;
  pose.information = options.information_discount * information;
  matches = search(frame, grids, pose.T_world_vehicle, kRefinedRadiusPx, Searched::kAll);
  return pose;
}

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

void VisualOdometry::State::triangulate_tracks(const VoKeyframe& keyframe) {
  std::vector<Ray> rays;
  for (std::size_t c = 0; c < keyframe.tracks.size(); ++c)
    for (const int id : keyframe.tracks[c]) {
      if (id < 0) continue;
      Track& track = result.tracks[static_cast<std::size_t>(id)];
      const std::size_t count = track.observations.size();
      if (count < 2) continue;
      rays.clear();
      const std::size_t used = std::min(count, kMaxRays);  // first and last among them
      for (std::size_t r = 0; r < used; ++r) {
        const std::size_t i = r * (count - 1) / (used - 1);
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

void VisualOdometry::State::start_tracks(VoKeyframe& keyframe, std::size_t index) {
  newest_tracks = result.tracks.size();
  for (std::size_t c = 0; c < keyframe.features.size(); ++c) {
    keyframe.tracks[c].resize(keyframe.features[c].size(), -1);
    for (std::size_t f = 0; f < keyframe.features[c].size(); ++f) {
      if (keyframe.tracks[c][f] >= 0) continue;
      const int id = static_cast<int>(result.tracks.size());
      result.tracks.push_back(
          {static_cast<int>(c), {{static_cast<int>(index), static_cast<int>(f)}}, std::nullopt});
      keyframe.tracks[c][f] = id;
      active[c].push_back(id);
    }
  }
}

void VisualOdometry::State::accept(VoFrame&& frame, const Matches& matches, VoKeyframe&& keyframe) {
  const std::size_t index = result.keyframes.size();
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
  for (auto& tracks : active)
    std::erase_if(tracks, [&](int id) {
      const auto& seen = result.tracks[static_cast<std::size_t>(id)].observations;
      // A corner that was not found again at once was hardly one; looking on for it costs the most.
      const int allowed = seen.size() == 1 ? 0 : options.max_skipped;
      return seen.back().keyframe < static_cast<int>(index) - allowed;
    });
  forget_lone_tracks();
  start_tracks(added, index);
}

// A piece that never came to a second keyframe says nothing: it makes room for the new start.
void VisualOdometry::State::drop_lone_start() {
  const auto index = static_cast<int>(result.keyframes.size()) - 1;
  if (index < 0 || (index > 0 && !last().after_gap)) return;
  while (!result.tracks.empty() && result.tracks.back().observations.front().keyframe == index)
    result.tracks.pop_back();
  newest_tracks = result.tracks.size();
  result.keyframes.pop_back();
}

VoOutcome VisualOdometry::State::start_segment(VoFrame&& frame, bool after_gap) {
  drop_lone_start();
  after_gap = after_gap && !result.keyframes.empty();
  VoKeyframe keyframe;
  if (!result.keyframes.empty()) {
    keyframe.T_odom_vehicle = predict(frame);
    keyframe.travelled_m = last().travelled_m + (frame.wheels ? frame.wheels->distance_m : 0.0);
    keyframe.reversing = frame.wheels && frame.wheels->reversing;
    keyframe.wheels = frame.wheels;
    if (frame.wheels) keyframe.information = planar_information(*frame.wheels);
  }
  keyframe.after_gap = after_gap;
  for (auto& tracks : active) tracks.clear();
  velocity.setZero();
  has_motion = false;
  Matches none;
  none.tracks.resize(frame.features.size());
  none.features.resize(frame.features.size());
  accept(std::move(frame), none, std::move(keyframe));
  return VoOutcome::kKeyframe;
}

// Corners of the last keyframe found again near their place, all cameras.
std::vector<BearingPair> VisualOdometry::State::pairs_with(const VoFrame& frame,
                                                           double& median_flow_px) const {
  const auto grids = make_grids(frame.features, rig);
  std::vector<BearingPair> pairs;
  std::vector<double> flows;
  for (std::size_t c = 0; c < active.size(); ++c) {
    std::vector<MatchQuery> queries;
    for (const int id : active[c]) {
      const TrackObservation& o = result.tracks[static_cast<std::size_t>(id)].observations.back();
      if (o.keyframe + 1 != static_cast<int>(result.keyframes.size())) continue;
      const Features& features = last().features[c];
      MatchQuery query;
      query.bearing = bearing_of(static_cast<int>(c), o);
      query.pixel = features.pixels[static_cast<std::size_t>(o.feature)];
      query.descriptor = &features.descriptors[static_cast<std::size_t>(o.feature)];
      queries.push_back(query);
    }
    const auto found = match_near(queries, frame.features[c], grids[c], kUnknownRadiusPx);
    for (std::size_t q = 0; q < found.size(); ++q) {
      if (found[q] < 0) continue;
      const Eigen::Vector2f& pixel = frame.features[c].pixels[static_cast<std::size_t>(found[q])];
      const auto bearing = rig.cameras[c].camera.bearing(pixel.cast<double>());
      if (!bearing) continue;
      pairs.push_back({static_cast<int>(c), queries[q].bearing, *bearing});
      flows.push_back(static_cast<double>((pixel - queries[q].pixel).norm()));
    }
  }
  median_flow_px = 0.0;
  if (flows.empty()) return pairs;
  const auto middle = flows.begin() + static_cast<std::ptrdiff_t>(flows.size() / 2);
  std::nth_element(flows.begin(), middle, flows.end());
  median_flow_px = *middle;
  return pairs;
}

// The arc that a car drives is preferred; a motion that only five free angles explain is taken
// where it explains far more corners of a single camera.
std::optional<Eigen::Isometry3d> VisualOdometry::State::first_motion(
    const std::vector<BearingPair>& pairs, double dt) const {
  // The speed of a moment ago where tracking was lost, a guess at the start.
  const double speed = velocity.head<3>().norm();
  const double guess_m = speed > 0.0 ? speed * dt : kGuessedSpeed * std::min(dt, 0.2);
  std::vector<Eigen::Isometry3d> mounts;
  for (const auto& mounted : rig.cameras) mounts.push_back(mounted.T_vehicle_camera);
  const auto arc = find_arc_motion(pairs, mounts, guess_m, 0.5 * tolerance_rad);
  const auto free_motion =
      mounts.size() == 1 ? find_two_view(pairs, 0.5 * tolerance_rad) : std::nullopt;
  if (!arc && !free_motion) return std::nullopt;
  Eigen::Isometry3d T_old_new = Eigen::Isometry3d::Identity();
  const bool arc_wins =
      arc && (!free_motion || 3 * arc->inliers.size() >= 2 * free_motion->inliers.size());
  if (arc_wins) {
    T_old_new = arc->T_old_new;
  } else {
    Eigen::Isometry3d T_camera = free_motion->T_old_new;
    T_camera.translation() *= guess_m;
    T_old_new = mounts[0] * T_camera * mounts[0].inverse();
  }
  // The ground tells the scale: depths below the cameras, along the vehicle's vertical.
  std::vector<double> ratios;
  int known = 0;
  for (const int i : arc_wins ? arc->inliers : free_motion->inliers) {
    const auto& pair = pairs[static_cast<std::size_t>(i)];
    const Eigen::Isometry3d& mount = mounts[static_cast<std::size_t>(pair.camera)];
    const Eigen::Isometry3d T_camera = mount.inverse() * T_old_new * mount;
    const std::array<Ray, 2> rays{
        Ray{Eigen::Vector3d::Zero(), pair.old_bearing},
        Ray{T_camera.translation(), T_camera.linear() * pair.new_bearing}};
    const auto point = triangulate(rays, options.min_parallax_rad);
    if (!point) continue;
    ++known;
    const double below = -(mount.linear() * point->p_world).z();
    if (below > 0.05 * point->p_world.norm()) ratios.push_back(mount.translation().z() / below);
  }
  // Points without parallax would leave the next frame with nothing to hold on to.
  const std::size_t agreeing = (arc_wins ? arc->inliers : free_motion->inliers).size();
  if (known < options.min_inliers + options.min_inliers / 4 ||
      5 * known < 2 * static_cast<int>(agreeing))
    return std::nullopt;
  // Without a view of the ground the guess stays until the map finds the scale.
  const auto scale = ground_scale(ratios, 6);
  if (scale) T_old_new.translation() *= scale->scale;
  return T_old_new;
}

// Without wheels: waits until the last keyframe and this frame show a motion.
VoOutcome VisualOdometry::State::add_waiting(VoFrame&& frame) {
  double flow_px = 0.0;
  const auto pairs = pairs_with(frame, flow_px);
  const double dt = static_cast<double>(frame.t_ns - last().t_ns) * 1e-9;
  if (pairs.size() < kFewestPairs)
    return dt > kLostSeconds ? start_segment(std::move(frame), true) : VoOutcome::kWaiting;
  if (flow_px < kFirstFlowPx) return VoOutcome::kWaiting;
  const auto T_old_new = first_motion(pairs, dt);
  if (!T_old_new) return VoOutcome::kWaiting;
  velocity = se3_log(*T_old_new) / dt;
  has_motion = true;
  return add_tracking(std::move(frame), true);
}

VoOutcome VisualOdometry::State::add_tracking(VoFrame&& frame, bool is_first_motion) {
  const auto grids = make_grids(frame.features, rig);
  Matches matches;
  std::optional<RigPose> pose;
  if (is_first_motion) {
    // No point is known yet: the two-view motion is taken as it is.
    matches = search(frame, grids, predict(frame), kRefinedRadiusPx, Searched::kAll);
    pose.emplace();
    pose->T_world_vehicle = predict(frame);
    pose->inliers = options.min_inliers;
    pose->information = Matrix6d::Identity() * 1e3;
  } else {
    const bool just_started = frame.wheels && (result.keyframes.size() == 1 || last().after_gap);
    if (just_started) pose = estimate_without_places(frame, grids, matches);
    if (!pose) pose = estimate(frame, grids, matches);
  }
  if (!pose) {  // lost: two views may still tell the motion
    has_motion = false;
    return add_waiting(std::move(frame));
  }
  const Eigen::Isometry3d T_last_new = last().T_odom_vehicle.inverse() * pose->T_world_vehicle;
  const double distance = T_last_new.translation().norm();
  const double turn = so3_log(T_last_new.linear()).norm();
  const double dt = static_cast<double>(frame.t_ns - last().t_ns) * 1e-9;
  if (!frame.wheels && dt > 0.0) velocity = se3_log(T_last_new) / dt;
  if (!frame.wheels && !is_first_motion && distance < options.spacing_m && turn < options.turn_rad)
    return VoOutcome::kTooClose;

  VoKeyframe keyframe;
  keyframe.T_odom_vehicle = pose->T_world_vehicle;
  keyframe.wheels = frame.wheels;
  keyframe.information = pose->information / options.information_discount;
  keyframe.inliers = pose->inliers;
  keyframe.travelled_m = last().travelled_m + distance;
  keyframe.reversing = T_last_new.translation().x() < 0.0;
  accept(std::move(frame), matches, std::move(keyframe));
  return VoOutcome::kKeyframe;
}

VisualOdometry::VisualOdometry(Rig half_rig, const VoOptions& options)
    : state_(std::make_unique<State>(std::move(half_rig), options)) {}
VisualOdometry::~VisualOdometry() = default;
VisualOdometry::VisualOdometry(VisualOdometry&&) noexcept = default;
VisualOdometry& VisualOdometry::operator=(VisualOdometry&&) noexcept = default;

VoOutcome VisualOdometry::add(VoFrame frame) {
  State& s = *state_;
  ROADBOOK_ASSERT(frame.features.size() == s.rig.cameras.size());
  if (s.result.keyframes.empty()) return s.start_segment(std::move(frame), false);
  if (frame.after_gap && !frame.wheels) return s.start_segment(std::move(frame), true);
  if (frame.wheels || s.has_motion) return s.add_tracking(std::move(frame), false);
  return s.add_waiting(std::move(frame));
}

VoResult VisualOdometry::finish() {
  state_->forget_lone_tracks();
  return std::move(state_->result);
}

}  // namespace roadbook
