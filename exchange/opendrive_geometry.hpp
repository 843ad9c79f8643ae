#pragma once

#include <vector>

#include "roadnet/path_curve.hpp"

namespace roadbook {

/// A cubic of OpenDRIVE (`paramPoly3` over arc length) in the frame of its begin: u ahead, v left.
struct DriveCubic {
  double s_m = 0.0;  ///< of its begin, from the begin of the road
  double x = 0.0, y = 0.0, heading = 0.0;
  double length_m = 0.0;
  double u[4]{};
  double v[4]{};
  double z[4]{};  ///< elevation over the same length

  /// The point at `p_m` along it.
  [[nodiscard]] Eigen::Vector2d at(double p_m) const;
};

/// A stretch of a path as cubics that leave it by no more than `tolerance_m`, compared at the same
/// arc length; position and direction are exact at their joints.
[[nodiscard]] std::vector<DriveCubic> drive_cubics(const PathCurve& curve,
                                                   double begin_m,
                                                   double end_m,
                                                   double tolerance_m = 1e-3);

}  // namespace roadbook
