#pragma once

#include <optional>
#include <vector>

#include "mapping/localisation/landmark_index.hpp"
#include "mapping/localisation/landmark_pose.hpp"
#include "mapping/localisation/landmark_search.hpp"

namespace roadbook {

// The pose of one frame from the landmarks that its images show, near a predicted pose.

struct FrameFixOptions {
  NearLandmarksOptions near;
  LandmarkSearchOptions search;
  LandmarkPoseOptions pose;
  int min_inliers = 20;
  double min_azimuth_rad = 1.5707963;  ///< that inliers of a single camera must span
  /// Multiplies the covariance that independent errors of the stated sizes would give.
  double noise_factor = 1.0;
  bool use_prior = true;  ///< the prediction takes part in the pose
  /// Multiplies the information of the prediction. It comes from the same landmarks as seen before,
  /// so that their errors would count twice.
  double prior_share = 0.25;

  /// Throws InvalidOption.
  void check() const;
};

/// A predicted pose.
struct PredictedPose {
  Eigen::Isometry3d T_map_vehicle = Eigen::Isometry3d::Identity();
  Matrix6d covariance = Matrix6d::Identity();  ///< of the right perturbation
};

struct FrameFix {
  Eigen::Isometry3d T_map_vehicle = Eigen::Isometry3d::Identity();
  Matrix6d covariance = Matrix6d::Identity();  ///< of the right perturbation, by landmarks alone
  std::vector<LandmarkView> views;             ///< inliers
  int matched = 0;                             ///< landmarks with a partner among the corners
  int cameras = 0;                             ///< that have at least three inliers
  double azimuth_rad = 0.0;  ///< that the inliers span around the vehicle, 0 to 2 pi
  double chi2 = 0.0;         ///< of the inliers; 2 per inlier expected
  double pull_found = 0.0;   ///< of LandmarkPose
  double pull_expected = 0.0;

  [[nodiscard]] int inliers() const { return static_cast<int>(views.size()); }
};

/// Searches the landmarks near the predicted pose, solves for the pose, and does both again from
/// there. Empty if the pose is not determined; a result may still have too few inliers. `in_view`
/// receives the landmarks that project into an image, ascending, whether or not there is a pose.
[[nodiscard]] std::optional<FrameFix> fix_frame(const Rig& half_rig,
                                                const FrameCorners& corners,
                                                const LandmarkIndex& index,
                                                const PredictedPose& predicted,
                                                const FrameFixOptions& options,
                                                std::vector<int>* in_view = nullptr);

/// Whether enough landmarks agree, from enough directions: in two cameras (three landmarks in
/// each), or over an angle of `min_azimuth_rad`, or, if the rig has one camera, over half of the
/// angle that it sees.
[[nodiscard]] bool has_enough(const FrameFix& fix, const Rig& rig, const FrameFixOptions& options);

}  // namespace roadbook
