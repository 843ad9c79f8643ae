#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "base/se3.hpp"

namespace roadbook {

/// Two views of one camera: directions of the same corner.
struct BearingPair {
  int camera = 0;
  Eigen::Vector3d old_bearing;
  Eigen::Vector3d new_bearing;
};

struct TwoView {
  Eigen::Isometry3d T_old_new = Eigen::Isometry3d::Identity();  ///< translation of unit length
  std::vector<int> inliers;
};

/// Relative pose of one camera by five-point RANSAC (OpenGV, Nister). Empty where the views do not
/// determine it: too few pairs or inliers, or hardly any motion. Deterministic.
[[nodiscard]] std::optional<TwoView> find_two_view(const std::vector<BearingPair>& pairs,
                                                   double inlier_rad);

/// Motion of the vehicle under the assumption that it drives along an arc (Scaramuzza 2011,
/// "1-point RANSAC"): one angle, and the tilt of the way, explain the pairs of all cameras, which
/// short baselines determine far better than five free angles.
///
/// `T_vehicle_camera` of each camera that the pairs name. The translation has length `distance_m`,
/// forwards, or backwards where more points then lie before the cameras.
[[nodiscard]] std::optional<TwoView> find_arc_motion(
    const std::vector<BearingPair>& pairs,
    const std::vector<Eigen::Isometry3d>& T_vehicle_camera,
    double distance_m,
    double inlier_rad);

/// Motion of the vehicle from a prior and the epipolar constraints of all cameras' matches of
/// unknown depth: Gauss-Newton with robust (Cauchy) weights of width `sigma_rad`. The scale stays
/// that of the prior, except for the information of cameras away from the axle in a turn.
/// `information` of the prior: right perturbation. Empty if it is singular.
[[nodiscard]] std::optional<Eigen::Isometry3d> refine_motion(
    const std::vector<BearingPair>& pairs,
    const std::vector<Eigen::Isometry3d>& T_vehicle_camera,
    const Eigen::Isometry3d& T_old_new,
    const Matrix6d& information,
    double sigma_rad);

}  // namespace roadbook
