#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "sensors/rig.hpp"
#include "vo/feature_grid.hpp"
#include "vo/features.hpp"

namespace roadbook {

// Finds a corner again in the next image, near the place where the motion predicts it.

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

/// Searches one camera's new image for `queries`; the vehicle moved by T_new_old. A corner of
/// unknown depth is searched for along its epipolar curve, which ends where the ray would pass
/// below the ground. Each feature is given to at most one query: the one nearest in descriptor.
/// Result: per query the index of the feature, or -1.
[[nodiscard]] std::vector<int> match_queries(const MountedCamera& mounted,
                                             const Eigen::Isometry3d& T_new_old,
                                             const std::vector<MatchQuery>& queries,
                                             const Features& features,
                                             const FeatureGrid& grid,
                                             double radius_px,
                                             const MatchOptions& options = {});

/// The same without any prediction: by place in the earlier image within `radius_px`.
[[nodiscard]] std::vector<int> match_near(const std::vector<MatchQuery>& queries,
                                          const Features& features,
                                          const FeatureGrid& grid,
                                          double radius_px,
                                          const MatchOptions& options = {});

}  // namespace roadbook
