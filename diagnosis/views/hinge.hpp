#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "base/se3.hpp"
#include "sensors/wheels.hpp"

namespace roadbook {

// Ground of two planes that meet in a line (the hinge), per radian of their change of slope, to
// first order: either side rises by half of it.

/// Points p of the line: normal . p = offset.
struct HingeLine {
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();
  double offset_m = 0.0;
  /// A point of the line about which it turns: where the drive crosses it, or the line would leave
  /// what is known of it.
  Eigen::Vector2d pivot = Eigen::Vector2d::Zero();

  /// Of a point of the map from the line [m], positive on the normal's side.
  [[nodiscard]] double distance(const Eigen::Vector2d& p) const { return normal.dot(p) - offset_m; }
  /// Height [m per rad] of the ground at a point of the map.
  [[nodiscard]] double height(const Eigen::Vector2d& p) const;
  /// Turned about its pivot and shifted along its normal.
  [[nodiscard]] HingeLine moved(double turn_rad, double shift_m) const {
    return moved(turn_rad, shift_m, pivot);
  }
  /// Turned about `place`; the pivot stays a point of the line.
  [[nodiscard]] HingeLine moved(double turn_rad,
                                double shift_m,
                                const Eigen::Vector2d& place) const;
};

/// What a hinge's size changes, and per radian of that what a turn [rad] of its line about its
/// pivot does, and a shift [m].
inline constexpr std::size_t kHingeColumns = 3;

/// These columns of what `change` makes of a line (a vector of `Rows`), by central differences.
template <int Rows, typename Change>
[[nodiscard]] Eigen::Matrix<double, Rows, 3> hinge_columns(const HingeLine& line,
                                                           const Change& change) {
  constexpr double kTurn = 0.002;  // [rad]
  constexpr double kShift = 0.05;  // [m]
  const auto by = [&](double turn, double shift) -> Eigen::Vector<double, Rows> {
    return change(line.moved(turn, shift));
  };
  Eigen::Matrix<double, Rows, 3> columns;
  columns.col(0) = change(line);
  columns.col(1) = (by(kTurn, 0.0) - by(-kTurn, 0.0)) / (2.0 * kTurn);
  columns.col(2) = (by(0.0, kShift) - by(0.0, -kShift)) / (2.0 * kShift);
  return columns;
}

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
