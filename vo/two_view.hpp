#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "base/se3.hpp"

namespace roadbook {

/// The directions (unit, camera frame) in which one camera saw the same corner at two times.
struct BearingPair {
  int camera = 0;  ///< index in the rig
  Eigen::Vector3d old_bearing;
  Eigen::Vector3d new_bearing;
};

struct TwoView {
  Eigen::Isometry3d T_old_new = Eigen::Isometry3d::Identity();  ///< translation of unit length
  std::vector<int> inliers;                                     ///< indices of the pairs
};

/// Estimates the relative pose of one camera by five-point RANSAC (OpenGV, Nister). `inlier_rad`:
/// largest angular error of an inlier. Empty if the views do not determine the pose: too few pairs
/// or inliers, or hardly any motion. Deterministic.
[[nodiscard]] std::optional<TwoView> find_two_view(const std::vector<BearingPair>& pairs,
                                                   double inlier_rad);

/// Estimates the motion of the vehicle if it drives along an arc (Scaramuzza 2011, "1-point
/// RANSAC"). One turn angle and the tilt of the way explain the pairs of all cameras. Short
/// baselines determine these far better than five free angles.
///
/// `T_vehicle_camera`: of each camera, by the index in the pairs. The translation of the result has
/// length `distance_m`. It points forwards, or backwards if more points then lie before the
/// cameras. Empty if the pairs do not determine the motion.
[[nodiscard]] std::optional<TwoView> find_arc_motion(
    const std::vector<BearingPair>& pairs,
    const std::vector<Eigen::Isometry3d>& T_vehicle_camera,
    double distance_m,
    double inlier_rad);

/// Refines the motion `T_old_new` of the vehicle, used as prior, by the epipolar constraints of all
/// pairs: Gauss-Newton with robust (Cauchy) weights of width `sigma_rad`. `information` belongs to
/// the prior (right perturbation). The scale stays that of the prior, unless cameras away from the
/// axle observe it in a turn. Empty if the system is singular.
[[nodiscard]] std::optional<Eigen::Isometry3d> refine_motion(
    const std::vector<BearingPair>& pairs,
    const std::vector<Eigen::Isometry3d>& T_vehicle_camera,
    const Eigen::Isometry3d& T_old_new,
    const Matrix6d& information,
    double sigma_rad);

}  // namespace roadbook
