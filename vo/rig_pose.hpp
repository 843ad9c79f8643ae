#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/se3.hpp"
#include "sensors/rig.hpp"

namespace roadbook {

// Pose of the vehicle from points with known positions that any of its cameras observed.

/// A point in the world (or in the frame of another vehicle pose), and the pixel that shows it.
struct RigObservation {
  int camera = 0;         ///< index in the rig
  Eigen::Vector2d pixel;  ///< in the image size of the rig's cameras
  Eigen::Vector3d p_world;
};

/// A Gaussian prior of the pose.
struct RigPosePrior {
  Eigen::Isometry3d T_world_vehicle;
  Matrix6d information;  ///< of the right perturbation
};

struct RigPose {
  Eigen::Isometry3d T_world_vehicle = Eigen::Isometry3d::Identity();
  Matrix6d information = Matrix6d::Zero();  ///< of the right perturbation, prior included
  std::vector<std::uint8_t> inlier;         ///< per observation
  int inliers = 0;
  /// Heading [rad] by the observations alone less that of the prior, to first order around the
  /// pose. 0 without a prior.
  double heading_beyond_prior_rad = 0.0;
};

struct RigPoseOptions {
  double sigma_px = 1.0;   ///< of one observation
  double inlier_px = 3.0;  ///< largest error of an inlier
  int iterations = 10;
  int ransac_iterations = 200;
  double ransac_inlier_rad = 0.015;  ///< angle between ray and point
};

/// Minimises the robust (Cauchy) reprojection errors by Gauss-Newton from `initial`, together with
/// the prior if one is given. Empty if the normal equations are singular.
[[nodiscard]] std::optional<RigPose> refine_rig_pose(const Rig& rig,
                                                     std::span<const RigObservation> observations,
                                                     const Eigen::Isometry3d& initial,
                                                     const std::optional<RigPosePrior>& prior,
                                                     const RigPoseOptions& options = {});

/// RANSAC with the generalised three-point solver over the whole rig (OpenGV GP3P; P3P by Kneip
/// for one camera), then `refine_rig_pose` on its inliers. Empty if no pose has enough inliers.
/// Deterministic: the seed is fixed.
[[nodiscard]] std::optional<RigPose> find_rig_pose(const Rig& rig,
                                                   std::span<const RigObservation> observations,
                                                   const RigPoseOptions& options = {});

}  // namespace roadbook
