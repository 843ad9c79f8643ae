#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

namespace roadbook {

/// Two views of one camera: directions of the same corners.
struct BearingPair {
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

/// Relative pose under the assumption that the vehicle drives on a plane along an arc (Scaramuzza
/// 2011, "1-point RANSAC"): one angle explains all pairs, which short baselines determine far
/// better than five. Bearings in the camera mounted at `T_vehicle_camera`; the result is the motion
/// of the VEHICLE, old to new, with a translation of `distance_m` forwards (or backwards, where
/// more points then lie before the camera).
[[nodiscard]] std::optional<TwoView> find_arc_motion(const std::vector<BearingPair>& pairs,
                                                     const Eigen::Isometry3d& T_vehicle_camera,
                                                     double distance_m,
                                                     double inlier_rad);

}  // namespace roadbook
