#pragma once

#include <vector>

#include "roadnet/paths/path_curve.hpp"

namespace roadbook {

/// Two positions of a path that are near each other in the plane and far apart along the path.
struct NearPair {
  double s_m = 0.0;
  double other_s_m = 0.0;
  double distance_m = 0.0;
};

struct NearPairs {
  double step_m = 0.0;          ///< between samples
  std::vector<NearPair> worst;  ///< a sample's nearest partner, refined where it is nearest of all
                                ///< around; only pairs within `within_m`
  /// Of every sample: whether it has a partner within reach; and whether it has, or one may lie
  /// between samples.
  std::vector<bool> sample_near;
  std::vector<bool> sample_maybe_near;
};

/// Finds all pairs nearer than `within_m` in the plane and more than `apart_m` apart along the
/// path.
[[nodiscard]] NearPairs near_pairs(const PathCurve& curve, double within_m, double apart_m);

}  // namespace roadbook
