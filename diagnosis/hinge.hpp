#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/se3.hpp"
#include "sensors/wheels.hpp"

namespace roadbook {

// Ground of two planes that meet in a line (the hinge), per radian of their change of slope, to
// first order: either side rises by half of it.

/// Points p of the line: normal . p = offset.
struct HingeLine {
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();
  double offset_m = 0.0;

  /// Height [m per rad] of the ground at a point of the map.
  [[nodiscard]] double height(const Eigen::Vector2d& p) const;
};

/// Right perturbation of the pose of a car that stands on such ground instead of flat ground, per
/// radian: its plane is that of least squares through the four points where the wheels stand.
struct HingeStand {
  double height = 0.0;      ///< of the rear axle's middle
  double rise_ahead = 0.0;  ///< slope of the car's x axis
  double rise_aside = 0.0;  ///< of its y axis

  [[nodiscard]] Vector6d perturbation() const {
    Vector6d xi;
    xi << 0.0, 0.0, height, rise_aside, -rise_ahead, 0.0;
    return xi;
  }
};
[[nodiscard]] HingeStand stand_on_hinge(const HingeLine& line,
                                        const Eigen::Isometry3d& T_map_vehicle,
                                        const WheelModel& car);

}  // namespace roadbook
