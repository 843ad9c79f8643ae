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

}  // namespace roadbook
