#pragma once

#include <vector>

#include "roadnet/paths/path_curve.hpp"

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

/// Limits of a cubic. Readers replace each cubic by chords; SUMO takes one chord for every 2 m.
/// Therefore no cubic is longer than that, or farther from its chord than `sagitta_m`. SUMO drops
/// points closer than 0.1 m.
struct DriveCubicOptions {
  double sagitta_m = 5e-4;
  double longest_m = 2.0;
  double shortest_m = 0.105;
};

/// A stretch of a road, arc lengths on its curve.
struct DriveStretch {
  double begin_m = 0.0;
  double end_m = 0.0;
};

/// Length of a single long cubic at the bent end of a road; 0 if the end is not bent. Without it,
/// netconvert reads the first two chords as a sharp turn.
[[nodiscard]] double bent_end_m(const PathCurve& curve, double at_m, double length_m);

/// Converts a stretch of a path to cubics; position and direction are exact at their joints. Each
/// stretch in `fixed` becomes one cubic.
[[nodiscard]] std::vector<DriveCubic> drive_cubics(const PathCurve& curve,
                                                   double begin_m,
                                                   double end_m,
                                                   const std::vector<DriveStretch>& fixed = {},
                                                   const DriveCubicOptions& options = {});

}  // namespace roadbook
