#include <array>

#include "vo/ground_scale.hpp"
#include "vo/odometry_state.hpp"
#include "vo/planar_motion.hpp"
#include "vo/triangulation.hpp"

namespace roadbook {
namespace {
constexpr double kGuessedSpeed = 5.0;  // [m/s] until the ground determines the scale
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
  held.reset();
  Matches none;
  none.tracks.resize(frame.features.size());
  none.features.resize(frame.features.size());
  accept(std::move(frame), none, std::move(keyframe));
  return VoOutcome::kKeyframe;
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
  // The ground determines the scale: depths below the cameras, along the vehicle's vertical.
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

}  // namespace roadbook
