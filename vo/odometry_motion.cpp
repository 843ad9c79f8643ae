#include <algorithm>

#include "vo/odometry_state.hpp"
#include "vo/planar_motion.hpp"
#include "vo/window/driving_prior.hpp"

namespace roadbook {

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

}  // namespace roadbook
