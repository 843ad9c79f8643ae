#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/se3.hpp"
#include "sensors/rig.hpp"

namespace roadbook {

// Pose of the vehicle from points of known place seen by any of its cameras.

/// A point in the world (or in the frame of another vehicle pose) and where a camera sees it.
struct RigObservation {
  int camera = 0;
  Eigen::Vector2d pixel;  ///< of the cameras of the rig passed along
  Eigen::Vector3d p_world;
};

struct RigPosePrior {
  Eigen::Isometry3d T_world_vehicle;
  Matrix6d information;
};

struct RigPose {
  Eigen::Isometry3d T_world_vehicle = Eigen::Isometry3d::Identity();
  Matrix6d information = Matrix6d::Zero();  ///< of the right perturbation, prior included
  std::vector<std::uint8_t> inlier;         ///< per observation
  int inliers = 0;
};

struct RigPoseOptions {
  double sigma_px = 1.0;   ///< of one observation
  double inlier_px = 3.0;  ///< largest error of an inlier
  int iterations = 10;
  int ransac_iterations = 200;
  double ransac_inlier_rad = 0.015;  ///< angle between ray and point
};

/// Gauss-Newton from `initial` on robust (Cauchy) reprojection errors, plus a prior where there is
/// one. Empty where the system is singular.
[[nodiscard]] std::optional<RigPose> refine_rig_pose(const Rig& rig,
                                                     std::span<const RigObservation> observations,
                                                     const Eigen::Isometry3d& initial,
                                                     const std::optional<RigPosePrior>& prior,
                                                     const RigPoseOptions& options = {});

/// RANSAC with the generalised three-point solver over the whole rig (OpenGV GP3P; P3P by Kneip
/// for one camera), then `refine_rig_pose` on its inliers. Empty where nothing agrees.
/// Deterministic: fixed seed.
[[nodiscard]] std::optional<RigPose> find_rig_pose(const Rig& rig,
                                                   std::span<const RigObservation> observations,
                                                   const RigPoseOptions& options = {});

}  // namespace roadbook
