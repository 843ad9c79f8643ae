#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/se3.hpp"
#include "sensors/rig.hpp"
#include "vo/rig_pose.hpp"

namespace roadbook {

/// A landmark that an image shows.
struct LandmarkPixel {
  int camera = 0;         ///< index in the rig
  Eigen::Vector2d pixel;  ///< in the image size of the rig's cameras
  Eigen::Vector3d p_map;
  Eigen::Matrix3d covariance;  ///< of `p_map` [m^2]
};

struct LandmarkPoseOptions {
  double sigma_px = 0.6;      ///< of a corner
  double loss_sigma = 1.5;    ///< width of the Cauchy loss, in standard deviations
  double inlier_sigma = 3.5;  ///< largest error of an inlier, in standard deviations
  int max_iterations = 20;
  double relative_tolerance = 1e-6;  ///< decrease of the cost by the last step
};

struct LandmarkPose {
  Eigen::Isometry3d T_map_vehicle = Eigen::Isometry3d::Identity();
  /// Of the right perturbation, by the landmarks alone, if the errors were independent, normal and
  /// of the stated sizes. The loss costs a part of it.
  Matrix6d information = Matrix6d::Zero();
  std::vector<std::uint8_t> inlier;  ///< by landmark
  int inliers = 0;
  double chi2 = 0.0;  ///< sum of the squared normalised errors of inliers, 2 * inliers expected
  /// How far groups of errors pull the pose together, and how far independent errors of the stated
  /// size would. `found / expected` is the factor on the covariance of the pose.
  double pull_found = 0.0;
  double pull_expected = 0.0;
};

/// What a Cauchy loss of this width makes of normal errors in two dimensions with unit variances:
/// E(w^2 e^2) and E(Hessian), relative to E(w), with the weight w = 1 / (1 + e^T e / width^2).
struct CauchyMoments {
  double squared_pull = 1.0;
  double hessian = 1.0;
};
[[nodiscard]] CauchyMoments cauchy_moments(double width_sigma);

/// Minimises the reprojection errors of landmarks by Ceres [metric-semantic maps, section IV-C].
/// An error is normalised by the covariance of the corner and of the landmark, seen from `initial`;
/// Cauchy loss. `prior`: what else is known of the pose; empty: nothing. One thread. Empty if the
/// pose is not determined.
///
/// Groups for the pull: the landmarks of one camera in one eighth of the horizon, whose errors have
/// causes in common. With J, r and H of the normal equations and g = J^T r of a group,
/// found = sum g^T H^-1 g, expected = sum tr((H_g - H_g H^-1 H_g) H^-1), as residuals are what the
/// six parameters leave of the errors (Liang and Zeger 1986, with the leverage of Bell and
/// McCaffrey 2002); for normal errors of the stated sizes, E(found) = expected with any loss.
[[nodiscard]] std::optional<LandmarkPose> solve_landmark_pose(
    const Rig& rig,
    std::span<const LandmarkPixel> pixels,
    const Eigen::Isometry3d& initial,
    const std::optional<RigPosePrior>& prior,
    const LandmarkPoseOptions& options = {});

}  // namespace roadbook
