#include "vo/visual_odometry.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "base/error.hpp"
#include "vo/odometry_state.hpp"

namespace roadbook {
namespace {
constexpr double kFirstFlowPx = 4.0;  // median motion of corners needed for a first motion
constexpr double kLostSeconds = 0.5;  // without pairs: a new start
}  // namespace

void VoOptions::check() const {
  if (!(spacing_m > 0.0)) throw InvalidOption("spacing_m", std::to_string(spacing_m), "> 0");
  if (!(turn_rad > 0.0)) throw InvalidOption("turn_rad", std::to_string(turn_rad), "> 0");
  if (!(feature_sigma_px > 0.0))
    throw InvalidOption("feature_sigma_px", std::to_string(feature_sigma_px), "> 0");
  if (min_inliers < 6) throw InvalidOption("min_inliers", std::to_string(min_inliers), ">= 6");
}

VisualOdometry::State::State(Rig half_rig, const VoOptions& vo_options)
    : rig(std::move(half_rig)),
      options(vo_options),
      spacing(vo_options.spacing_m, vo_options.turn_rad) {
  options.check();
  double focal = 1e9;
  for (const auto& mounted : rig.cameras) focal = std::min(focal, mounted.camera.focal_px());
  tolerance_rad = options.inlier_px / focal;
  active.resize(rig.cameras.size());
}

Eigen::Vector3d VisualOdometry::State::bearing_of(int camera, const TrackObservation& o) const {
  const auto c = static_cast<std::size_t>(camera);
  const Eigen::Vector2f& pixel = result.keyframes[static_cast<std::size_t>(o.keyframe)]
                                     .features[c]
                                     .pixels[static_cast<std::size_t>(o.feature)];
  return rig.cameras[c].camera.bearing(pixel.cast<double>()).value_or(Eigen::Vector3d::UnitZ());
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
    // No point is known yet: the two-view motion is used directly.
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
    held.reset();
    return add_waiting(std::move(frame));
  }
  const Eigen::Isometry3d T_last_new = last().T_odom_vehicle.inverse() * pose->T_world_vehicle;
  const double distance = T_last_new.translation().norm();
  const double turn = so3_log(T_last_new.linear()).norm();
  const double dt = static_cast<double>(frame.t_ns - last().t_ns) * 1e-9;
  if (dt > 0.0) velocity = se3_log(T_last_new) / dt;
  // Where the wheels end, the cameras go on from the last motion.
  if (frame.wheels && dt > 0.0) has_motion = true;
  VoKeyframe keyframe;
  keyframe.T_odom_vehicle = pose->T_world_vehicle;
  keyframe.wheels = frame.wheels;
  keyframe.information = pose->information / options.information_discount;
  keyframe.inliers = pose->inliers;
  if (frame.wheels) keyframe.turn_beyond_wheels_rad = pose->heading_beyond_prior_rad;
  keyframe.travelled_m = last().travelled_m + distance;
  keyframe.reversing = T_last_new.translation().x() < 0.0;
  if (!frame.wheels && !is_first_motion) {
    if (spacing.progress(distance, turn) < 1.0) {
      held = {std::move(frame), std::move(matches), std::move(keyframe), distance, turn};
      return VoOutcome::kTooClose;
    }
    if (is_held_nearer(distance, turn)) {
      accept_held();
      (void)add_tracking(std::move(frame), false);
      return VoOutcome::kKeyframe;
    }
  }
  held.reset();
  accept(std::move(frame), matches, std::move(keyframe));
  return VoOutcome::kKeyframe;
}

// A motion that is far from constant is a frame whose pose is wrong rather than one that lies near:
// without wheels nothing else shows that.
bool VisualOdometry::State::is_held_nearer(double distance_m, double turn_rad) const {
  constexpr double kMostUneven = 3.0;  // frames at equal times in steady motion: 2 at most
  return held && distance_m <= kMostUneven * held->distance_m &&
         KeyframeSpacing::first_is_nearer(spacing.progress(held->distance_m, held->turn_rad),
                                          spacing.progress(distance_m, turn_rad));
}

void VisualOdometry::State::accept_held() {
  HeldFrame taken = std::move(*held);
  held.reset();
  accept(std::move(taken.frame), taken.matches, std::move(taken.keyframe));
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

std::optional<std::int64_t> VisualOdometry::last_keyframe_ns() const {
  if (state_->result.keyframes.empty()) return std::nullopt;
  return state_->last().t_ns;
}

VoResult VisualOdometry::finish() {
  state_->forget_lone_tracks();
  return std::move(state_->result);
}

}  // namespace roadbook
