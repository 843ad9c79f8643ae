#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "sensors/camera_centre.hpp"
#include "vo/ground_scale.hpp"
#include "vo/odometry_state.hpp"
#include "vo/window/window_adjustment.hpp"

namespace roadbook {
namespace {

constexpr int kFreePoses = 7;        // newest keyframes of a window; those before them stay
constexpr int kStartKeyframes = 30;  // of a stretch, while the scale is hardly known

// Scale by the ground around a pose of the window. Where a slope begins, the ground ahead is tilted
// and would look like another height: of several tilts, the one that most points agree on counts.
std::optional<GroundScale> scale_by_ground_around(const VoWindow& window,
                                                  std::size_t pose,
                                                  double camera_height_m) {
  constexpr double kAheadHeights = 10.0;  // farther away, a small tilt is a large error
  constexpr double kBesideHeights = 4.0;
  constexpr int kFewest = 20;
  constexpr double kLeastShare = 0.15;
  constexpr int kTilts = 4;              // to either side
  constexpr double kTiltStep = 0.025;    // [rad]
  constexpr double kLevelSupport = 1.1;  // factor on the support of a ground without tilt
  const Eigen::Isometry3d T_vehicle_odom = window.T_odom_vehicle[pose].inverse();
  std::vector<Eigen::Vector3d> near;
  for (const Eigen::Vector3d& point : window.points) {
    const Eigen::Vector3d p = T_vehicle_odom * point;
    if (std::abs(p.x()) < kAheadHeights * camera_height_m &&
        std::abs(p.y()) < kBesideHeights * camera_height_m)
      near.push_back(p);
  }
  std::optional<GroundScale> best;
  double most = kLeastShare * static_cast<double>(near.size());
  for (int tilt = -kTilts; tilt <= kTilts; ++tilt) {
    std::vector<double> ratios;
    for (const Eigen::Vector3d& p : near)
      ratios.push_back(camera_height_m / (camera_height_m - p.z() + kTiltStep * tilt * p.x()));
    const auto found = ground_scale(std::move(ratios), kFewest);
    if (!found) continue;
    const double support = (tilt == 0 ? kLevelSupport : 1.0) * found->support;
    if (support <= most) continue;
    most = support;
    best = found;
  }
  return best;
}

// Multiplies the lengths of the window, seen from its first pose.
void multiply_lengths(double factor, const Eigen::Vector3d& camera_centre, VoWindow& window) {
  const Eigen::Vector3d origin = window.T_odom_vehicle.front() * camera_centre;
  const auto scaled = [&](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    return origin + factor * (p - origin);
  };
  for (Eigen::Isometry3d& T : window.T_odom_vehicle)
    T.translation() = scaled(T * camera_centre) - T.linear() * camera_centre;
  for (Eigen::Vector3d& point : window.points) point = scaled(point);
}

// The part of the ground's scale that the window follows after a keyframe: at the start of a
// stretch at once, later slowly, as ramps and kerbs pass by.
double log_factor_to_follow(double log_scale, int keyframes) {
  constexpr double kStartShare = 0.3;
  constexpr double kShare = 0.05;
  constexpr double kMost = 0.1;
  const double share = keyframes < kStartKeyframes ? kStartShare : kShare;
  return std::clamp(share * log_scale, -kMost, kMost);
}

}  // namespace

// The newest poses since the last gap, and the corners that they see.
VoWindow VisualOdometry::State::newest_window(std::vector<int>& tracks) const {
  const int count = static_cast<int>(result.keyframes.size());
  int first = count - 1;
  while (first > 0 && count - first < kWindowPoses && !keyframe_at(first).after_gap) --first;
  VoWindow window;
  window.fixed = std::max(1, count - first - kFreePoses);
  std::vector<int> seen;
  for (int k = first; k < count; ++k) {
    window.T_odom_vehicle.push_back(keyframe_at(k).T_odom_vehicle);
    if (keyframe_at(k).wheels) window.fixed = std::max(window.fixed, k - first + 1);
    for (const auto& of_camera : keyframe_at(k).tracks)
      std::copy_if(of_camera.begin(), of_camera.end(), std::back_inserter(seen),
                   [](int id) { return id >= 0; });
  }
  std::sort(seen.begin(), seen.end());
  seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
  for (const int id : seen) {
    const Track& track = result.tracks[static_cast<std::size_t>(id)];
    const auto& all = track.observations;
    if (!track.p_odom || all.size() < 2 || all[all.size() - 2].keyframe < first) continue;
    const auto begin = std::find_if(all.rbegin(), all.rend(), [&](const TrackObservation& o) {
                         return o.keyframe < first;
                       }).base();
    for (auto o = begin; o != all.end(); ++o) {
      window.views.push_back({o->keyframe - first, static_cast<int>(tracks.size()), track.camera,
                              keyframe_at(o->keyframe)
                                  .features[static_cast<std::size_t>(track.camera)]
                                  .pixels[static_cast<std::size_t>(o->feature)]
                                  .cast<double>()});
    }
    tracks.push_back(id);
    window.points.push_back(*track.p_odom);
  }
  return window;
}

// Lets the lengths of the window follow the ground. Poses that the wheels know have their scale.
void VisualOdometry::State::follow_ground(VoWindow& window) {
  const auto size = window.T_odom_vehicle.size();
  const auto first = result.keyframes.size() - size;
  const auto height_m = known_camera_height(rig);
  if (!height_m) return;
  if (size > kFreePoses + 1) {
    // A pose that is free no longer keeps what the ground says of it now: the adjustment has moved
    // it since it was the newest.
    const std::size_t settled = size - 1 - kFreePoses;
    VoKeyframe& keyframe = result.keyframes[first + settled];
    const auto there = scale_by_ground_around(window, settled, *height_m);
    keyframe.ground_log_scale =
        there && !keyframe.wheels ? std::optional(std::log(there->scale)) : std::nullopt;
  }
  const auto scale = scale_by_ground_around(window, size - 1, *height_m);
  if (!scale) return;
  last().ground_log_scale = std::log(scale->scale);
  if (std::any_of(result.keyframes.begin() + static_cast<std::ptrdiff_t>(first),
                  result.keyframes.end(), [](const VoKeyframe& k) { return k.wheels.has_value(); }))
    return;
  int stretch = 1;
  for (std::size_t k = result.keyframes.size() - 1;
       k > 0 && stretch < kStartKeyframes && !result.keyframes[k].after_gap; --k)
    ++stretch;
  const double log_factor = log_factor_to_follow(*last().ground_log_scale, stretch);
  const double factor = std::exp(log_factor);
  multiply_lengths(factor, centre_of_cameras(rig), window);
  for (std::size_t k = first; k < result.keyframes.size(); ++k) {
    VoKeyframe& keyframe = result.keyframes[k];
    if (keyframe.ground_log_scale) *keyframe.ground_log_scale -= log_factor;
    if (k == first) continue;
    keyframe.information.topLeftCorner<3, 3>() /= factor * factor;
    keyframe.information.topRightCorner<3, 3>() /= factor;
    keyframe.information.bottomLeftCorner<3, 3>() /= factor;
  }
}

// Cameras alone: adjusts the newest poses together with the corners that they see.
void VisualOdometry::State::adjust_newest() {
  if (last().wheels || last().after_gap) return;
  std::vector<int> tracks;
  VoWindow window = newest_window(tracks);
  const std::size_t size = window.T_odom_vehicle.size();
  if (size < 3) return;
  follow_ground(window);
  WindowOptions window_options;
  window_options.sigma_px = options.feature_sigma_px;
  window_options.least_views = options.min_inliers;
  adjust_window(rig, window_options, window);
  const std::size_t first = result.keyframes.size() - size;
  for (std::size_t k = 0; k < size; ++k) {
    VoKeyframe& keyframe = result.keyframes[first + k];
    keyframe.T_odom_vehicle = window.T_odom_vehicle[k];
    if (k == 0) continue;
    const Eigen::Vector3d way =
        (window.T_odom_vehicle[k - 1].inverse() * window.T_odom_vehicle[k]).translation();
    keyframe.travelled_m = result.keyframes[first + k - 1].travelled_m + way.norm();
    if (!keyframe.wheels) keyframe.reversing = way.x() < 0.0;
  }
  for (std::size_t i = 0; i < tracks.size(); ++i)
    result.tracks[static_cast<std::size_t>(tracks[i])].p_odom = window.points[i];
  const VoKeyframe& before = result.keyframes[result.keyframes.size() - 2];
  const double dt = static_cast<double>(last().t_ns - before.t_ns) * 1e-9;
  if (dt > 0.0) velocity = se3_log(before.T_odom_vehicle.inverse() * last().T_odom_vehicle) / dt;
}

}  // namespace roadbook
