#include <algorithm>
#include <cmath>
#include <utility>

#include "vo/ground_scale.hpp"
#include "vo/odometry_state.hpp"
#include "vo/window/window_adjustment.hpp"

namespace roadbook {
namespace {

constexpr int kFreePoses =
    7;  // newest keyframes of a window; the views of those before hold points
constexpr double kLeastHeightM = 0.05;  // of cameras whose height is known

Eigen::Vector3d centre_of(const Rig& rig) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& mounted : rig.cameras) sum += mounted.T_vehicle_camera.translation();
  return sum / static_cast<double>(rig.cameras.size());
}

// Scale by the ground around the newest pose. Where a slope begins, the ground ahead is tilted and
// would look like another height: of several tilts, the one that most points agree on counts.
std::optional<GroundScale> scale_around(const VoWindow& window, double camera_height_m) {
  constexpr double kAheadHeights = 10.0;  // farther away, a small tilt is a large error
  constexpr double kBesideHeights = 4.0;
  constexpr int kFewest = 20;
  constexpr double kLeastShare = 0.15;
  constexpr int kTilts = 4;             // to either side
  constexpr double kTiltStep = 0.025;   // [rad]
  constexpr double kMoreSupport = 1.1;  // that a tilted ground needs
  const Eigen::Isometry3d T_vehicle_odom = window.T_odom_vehicle.back().inverse();
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
    const double support = (tilt == 0 ? kMoreSupport : 1.0) * found->support;
    if (support <= most) continue;
    most = support;
    best = found;
  }
  return best;
}

// Multiplies the lengths of the window, seen from its first pose.
void multiply_lengths(double factor, const Eigen::Vector3d& camera_centre, VoWindow& window) {
  const Eigen::Vector3d origin = window.T_odom_vehicle.front() * camera_centre;
  const auto moved = [&](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    return origin + factor * (p - origin);
  };
  for (Eigen::Isometry3d& T : window.T_odom_vehicle)
    T.translation() = moved(T * camera_centre) - T.linear() * camera_centre;
  for (Eigen::Vector3d& point : window.points) point = moved(point);
}

// The part of the ground's scale that a keyframe follows: at the start at once, later slowly, as
// ramps and kerbs pass by.
double followed(double log_scale, int keyframes) {
  constexpr int kStart = 30;
  constexpr double kStartShare = 0.3;
  constexpr double kShare = 0.05;
  constexpr double kMost = 0.1;
  return std::clamp((keyframes < kStart ? kStartShare : kShare) * log_scale, -kMost, kMost);
}

}  // namespace

// The newest poses since the last gap, and the corners that they see.
VoWindow VisualOdometry::State::newest_window(std::vector<int>& tracks) const {
  const int count = static_cast<int>(result.keyframes.size());
  int first = count - 1;
  while (first > 0 && count - first < kWindowPoses && !keyframe_at(first).after_gap) --first;
  VoWindow window;
  window.fixed = std::max(1, count - first - kFreePoses);
  for (int k = first; k < count; ++k) {
    window.T_odom_vehicle.push_back(keyframe_at(k).T_odom_vehicle);
    if (keyframe_at(k).wheels) window.fixed = std::max(window.fixed, k - first + 1);
  }
  for (const auto& of_camera : active)
    for (const int id : of_camera) {
      const Track& track = result.tracks[static_cast<std::size_t>(id)];
      if (!track.p_odom) continue;
      const std::size_t before = window.views.size();
      for (const TrackObservation& o : track.observations)
        if (o.keyframe >= first)
          window.views.push_back({o.keyframe - first, static_cast<int>(tracks.size()), track.camera,
                                  keyframe_at(o.keyframe)
                                      .features[static_cast<std::size_t>(track.camera)]
                                      .pixels[static_cast<std::size_t>(o.feature)]
                                      .cast<double>()});
      if (window.views.size() - before < 2) {
        window.views.resize(before);
        continue;
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
  const Eigen::Vector3d centre = centre_of(rig);
  if (centre.z() < kLeastHeightM) return;
  const auto scale = scale_around(window, centre.z());
  if (!scale) return;
  last().ground_log_scale = std::log(scale->scale);
  if (std::any_of(result.keyframes.begin() + static_cast<std::ptrdiff_t>(first),
                  result.keyframes.end(), [](const VoKeyframe& k) { return k.wheels.has_value(); }))
    return;
  int stretch = 1;
  for (std::size_t k = result.keyframes.size() - 1; k > 0 && !result.keyframes[k].after_gap; --k)
    ++stretch;
  const double log_factor = followed(*last().ground_log_scale, stretch);
  multiply_lengths(std::exp(log_factor), centre, window);
  for (std::size_t k = first; k < result.keyframes.size(); ++k)
    if (auto& log_scale = result.keyframes[k].ground_log_scale) *log_scale -= log_factor;
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
  window_options.width_px = options.inlier_px;
  adjust_window(rig, window_options, window);
  const std::size_t first = result.keyframes.size() - size;
  for (std::size_t k = 0; k < size; ++k) {
    VoKeyframe& keyframe = result.keyframes[first + k];
    keyframe.T_odom_vehicle = window.T_odom_vehicle[k];
    if (k > 0)
      keyframe.travelled_m =
          result.keyframes[first + k - 1].travelled_m +
          (window.T_odom_vehicle[k].translation() - window.T_odom_vehicle[k - 1].translation())
              .norm();
  }
  for (std::size_t i = 0; i < tracks.size(); ++i)
    result.tracks[static_cast<std::size_t>(tracks[i])].p_odom = window.points[i];
  const VoKeyframe& before = result.keyframes[result.keyframes.size() - 2];
  const double dt = static_cast<double>(last().t_ns - before.t_ns) * 1e-9;
  if (dt > 0.0) velocity = se3_log(before.T_odom_vehicle.inverse() * last().T_odom_vehicle) / dt;
}

}  // namespace roadbook
