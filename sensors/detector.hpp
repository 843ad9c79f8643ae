#pragma once

#include <Eigen/Core>
#include <cmath>

#include "sensors/effects.hpp"

namespace roadbook {

// Model of a detector of people: the probability that it finds a person in sight of a camera, and
// the foot point (ground contact) that it reports.

/// The nominal detector, similar to `roadbook detect` (docs/guide/people.md).
struct DetectorModel {
  double every_s = 0.2;       ///< time between two searched images
  double max_range_m = 10;    ///< from the camera; people beyond are not searched for
  double min_range_m = 1.0;   ///< people nearer are not searched for
  double recall = 0.95;       ///< probability to find a person in sight, at any range
  double sigma_along = 0.05;  ///< of the foot point along the line of sight, relative to the range
  double sigma_across_m = 0.05;       ///< of the foot point across the line of sight
  double sigma_least_m = 0.03;        ///< lower bound of the standard deviation along
  double false_alarms_a_look = 0.05;  ///< mean number in a searched image, anywhere in sight
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

/// Returns the log odds of finding a person `range_m` from the camera. `nominal`: log odds of the
/// nominal detector at any range.
template <typename T>
T predict_found(const DetectorImperfections<T>& off, double nominal, double range_m) {
  return T(nominal) - off.range * T(range_m);
}

/// Returns the reported foot point of a person who stands at `foot`, seen by a camera at `eye`.
/// Both are in one planar frame [m] and differ.
template <typename T>
Eigen::Matrix<T, 2, 1> predict_foot(const DetectorImperfections<T>& off,
                                    const Eigen::Vector2d& eye,
                                    const Eigen::Vector2d& foot) {
  const Eigen::Vector2d along = (foot - eye).normalized();
  return foot.cast<T>() + off.foot_point * along.cast<T>();
}

}  // namespace roadbook
