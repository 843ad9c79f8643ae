#pragma once

#include <Eigen/Core>
#include <cmath>

#include "sensors/effects.hpp"

namespace roadbook {

// Model of a people detector: whether it finds a person in sight of a camera, and where it puts the
// feet.

/// The nominal detector: about what `roadbook detect` does (docs/guide/people.md).
struct DetectorModel {
  double every_s = 0.2;     ///< between two looks
  double max_range_m = 10;  ///< from the camera; farther people are not looked for
  double min_range_m = 1.0;
  double recall = 0.95;       ///< of a person in sight, at any range
  double sigma_along = 0.05;  ///< of the feet along the line of sight, relative to the range
  double sigma_across_m = 0.05;
  double sigma_least_m = 0.03;        ///< along, however near
  double false_alarms_a_look = 0.05;  ///< mean number, anywhere in sight
};

/// Sizes of the effects "detector.X" (units: sensors/reading_effects.cpp); all zero: the nominal
/// detector.
template <typename T>
struct DetectorImperfections {
  T range{0.0};       ///< [1/m]
  T foot_point{0.0};  ///< [m]
};

[[nodiscard]] inline DetectorImperfections<double> detector_imperfections(
    const EffectSizes& sizes) {
  return {effect_size(sizes, "detector", "range"), effect_size(sizes, "detector", "foot_point")};
}

/// Log odds of finding a person `range_m` from the camera, if the nominal detector has the log odds
/// `nominal` at any range.
template <typename T>
T predict_found(const DetectorImperfections<T>& off, double nominal, double range_m) {
  return T(nominal) - off.range * T(range_m);
}

/// Where the feet are placed that stand at `foot`, seen from `eye` (both in one plane frame, apart
/// from each other).
template <typename T>
Eigen::Matrix<T, 2, 1> predict_foot(const DetectorImperfections<T>& off,
                                    const Eigen::Vector2d& eye,
                                    const Eigen::Vector2d& foot) {
  const Eigen::Vector2d along = (foot - eye).normalized();
  return foot.cast<T>() + off.foot_point * along.cast<T>();
}

}  // namespace roadbook
