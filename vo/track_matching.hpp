#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "sensors/rig.hpp"
#include "vo/feature_grid.hpp"
#include "vo/features.hpp"

namespace roadbook {

// Matching of corners with the features of the next image, near the pixel that the motion predicts.

struct MatchOptions {
  int max_hamming = 110;    ///< of 512 bits
  double max_ratio = 0.85;  ///< best / second-best distance
  double nearest_m = 0.5;   ///< points closer to the camera are not searched for
};

/// A corner to be searched for.
struct MatchQuery {
  Eigen::Vector3d bearing;                   ///< in the earlier camera frame
  std::optional<Eigen::Vector3d> p_vehicle;  ///< its place in the new vehicle frame, where known
  Eigen::Vector2f pixel;                     ///< in the earlier image
  const Descriptor* descriptor = nullptr;
};

/// Searches one camera's new image for `queries`, after the vehicle moved by T_new_old. Searches
/// within `radius_px` of the predicted pixel. A corner of unknown depth is searched for along its
/// epipolar curve, which ends where the ray would pass below the ground. Each feature goes to at
/// most one query: the one with the nearest descriptor. Returns the index of the feature for each
/// query, or -1.
[[nodiscard]] std::vector<int> match_queries(const MountedCamera& mounted,
                                             const Eigen::Isometry3d& T_new_old,
                                             const std::vector<MatchQuery>& queries,
                                             const Features& features,
                                             const FeatureGrid& grid,
                                             double radius_px,
                                             const MatchOptions& options = {});

/// The same without a prediction: searches within `radius_px` of the pixel in the earlier image.
[[nodiscard]] std::vector<int> match_near(const std::vector<MatchQuery>& queries,
                                          const Features& features,
                                          const FeatureGrid& grid,
                                          double radius_px,
                                          const MatchOptions& options = {});

}  // namespace roadbook
